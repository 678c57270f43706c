#include "millscope/pack.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace millscope;

namespace {

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Every lane of `f(Pack…)` has the bits of `f(double…)`.
template <class F>
void check_lanes(F f) {
  const double values[] = {0.0, -0.0, 1.0, -2.5, 3e-300, 1e300, 7.0, -1e-5};
  for (const double first : values) {
    double b[kLanes], packed[kLanes];
    std::memcpy(b, values, sizeof b);
    for (int s = 0; s < kLanes; s += kPackWidth) store(packed + s, f(Pack(first), load<Pack>(b + s)));
    for (int s = 0; s < kLanes; ++s) CHECK(same(packed[s], f(first, b[s])));
  }
}

}  // namespace

TEST_CASE("packs give the bits of doubles") {
  check_lanes([](auto a, auto b) { return a + b; });
  check_lanes([](auto a, auto b) { return a - b; });
  check_lanes([](auto a, auto b) { return a * b; });
  check_lanes([](auto a, auto b) { return minimum(a, b); });
  check_lanes([](auto a, auto b) { return maximum(a, b); });
  check_lanes([](auto a, auto b) { return select(a < b || a > b, a, b); });
  check_lanes([](auto a, auto b) { return absolute(a) + absolute(b) + square_root(absolute(b)); });
  check_lanes([](auto, auto b) { return absolute(b); });
  check_lanes([](auto a, auto b) { return -a * b; });
}

TEST_CASE("sums and truth of lanes") {
  CHECK(lane_sum(Pack(1.5)) == 1.5 * kPackWidth);
  CHECK(any(Pack(1.0) > Pack(0.0)));
  CHECK_FALSE(any(Pack(1.0) < Pack(0.0)));
}
