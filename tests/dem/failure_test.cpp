// What stops a run: a step too long, a bead that leaves, periods too short; and that the message says where.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"

using namespace dem_test;

namespace {

std::string message(Assembly& a, int steps) {
  try {
    advance(a, steps);
  } catch (const base::UserError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a time step that is far too long is refused, or with allow_unstable the explosion names time and bead") {
  Setup s;
  s.geometry = "{box: {kind: box, low: [0, 0, 0], high: [40 mm, 40 mm, 40 mm], material: wall}}";
  s.fill = "{count: 150, settle_s: 0}";
  s.body_forces = kWithGravity;
  s.time = "{end_s: 100, step_fraction: 0.99}";
  CHECK_THROWS_WITH(assembled(s), Catch::Contains("Rayleigh") && Catch::Contains("allow_unstable"));
  s.run = "{partitions: 4, allow_unstable: true}";
  s.time = "{end_s: 100, step_s: 4e-4}";
  Assembly a = assembled(s);
  run::insert_beads(a);
  run::begin(a);
  const std::string text = message(a, 20000);
  CHECK_THAT(text, Catch::Contains("at t = ") && Catch::Contains(" bead ") && Catch::Contains("time.step_fraction"));
}

TEST_CASE("a bead that leaves the domain stops the run") {
  Setup s;
  s.domain = "{low: [-0.1, -0.1, -0.1], high: [0.1, 0.1, 0.1]}";
  s.body_forces = kWithGravity;
  Assembly a = assembled(s);
  start(a, {Bead{}, Bead{{0.03, 0, 0}, {1, 0, 0}}});
  const std::string text = message(a, 100000);
  CHECK_THAT(text, Catch::Contains("has left the domain") && Catch::Contains("bead 1"));
  CHECK(a.system->time() < 0.12);
  Assembly b = assembled(s);
  CHECK_THROWS_WITH(start(b, {Bead{{0, 0.2, 0}}}), Catch::Contains("has left the domain"));
}

TEST_CASE("NaN never goes on silently") {
  Setup s;
  for (const int where : {0, 1}) {
    Assembly a = assembled(s);
    start(a, {Bead{}, Bead{{0.03, 0, 0}}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (where == 0) {
      a.system->particles.position[1].centre[1] = nan;
    } else {
      a.system->particles.half[1].v[1] = nan;
    }
    CHECK_THAT(message(a, 10), Catch::Contains("bead 1"));
  }
}

TEST_CASE("beads in the very same place are an error, not a crash") {
  Assembly a = assembled(Setup{});
  start(a, {Bead{}, Bead{}});
  CHECK_THAT(message(a, 10), Catch::Contains("overlapped"));
}

TEST_CASE("a period shorter than two interaction distances is refused with the length that is needed") {
  Setup s;
  s.domain = "{periodic: {z: [0, 15.9 mm]}}";
  Assembly a = assembled(s);
  CHECK_THROWS_WITH(start(a, {Bead{}}), Catch::Contains("along z") && Catch::Contains("0.016"));
}
