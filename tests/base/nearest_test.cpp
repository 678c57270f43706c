// What a mistyped name was meant to be.
#include "kernel/base/nearest.hpp"

#include <catch2/catch.hpp>

using namespace millscope::base;

TEST_CASE("the nearest name is found by its letters, and none that is far") {
  CHECK(nearest("densty", {"density", "diameter"}) == "density");
  CHECK(nearest("poisson-ratio", {"poisson_ratio"}) == "poisson_ratio");
  CHECK(nearest("xyz", {"density", "diameter"}) == "");
  CHECK(nearest("ab", {"ba"}) == "ba");
  CHECK(nearest("poiss", {"density", "poisson_ratio"}) == "poisson_ratio");
}

TEST_CASE("a suggestion asks for the nearest, or lists what there is") {
  CHECK(suggestion("densty", {"density", "diameter"}) == "did you mean 'density'?");
  CHECK(suggestion("xyz", {"density", "diameter"}) == "known: density, diameter");
  CHECK(suggestion("xyz", {}) == "no key is known here");
}
