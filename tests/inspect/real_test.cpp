// Real recordings, where they are present, and the stand-in for a mill whose axis and speed are known.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "studies/inspect/inspect.hpp"
#include "tests/skip.hpp"

using namespace millscope;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using testing::absent;

namespace {

constexpr double kRpm = 30 / std::numbers::pi;

bool holds(const inspect::Finding& f, double truth) { return f.estimate && f.estimate->low <= truth && truth <= f.estimate->high; }

}  // namespace

TEST_CASE("real rotor: radius and plateaus") {
  if (absent("rotor_calibration.a")) return;
  const auto rotor = inspect::recognise_rotor(recording::read_recording(testing::recording("rotor_calibration.a")));
  REQUIRE(rotor);
  CHECK_THAT(rotor->radius.value, WithinAbs(26.6e-3, 0.15e-3));
  CHECK(rotor->radius.low < 26.6e-3);
  CHECK(rotor->radius.high > 26.6e-3);
  REQUIRE(rotor->plateaus.size() == 4);
  const double rpm[] = {8.8, 57.4, 120, 180.5};
  for (std::size_t p = 0; p < 4; ++p) CHECK_THAT(rotor->plateaus[p].speed.value * kRpm, WithinRel(rpm[p], 0.01));
}

TEST_CASE("real mill: axis, sense, speed, radius and vertical") {
  if (absent("uct_mill_part1.a")) return;
  const inspect::Inspection i = inspect::inspect(recording::read_recording(testing::recording("uct_mill_part1.a")));
  CHECK_FALSE(i.rotor);
  CHECK(i.motion.sense == -1);
  CHECK_THAT(i.motion.speed.estimate->value * kRpm, WithinAbs(36, 0.5));
  CHECK_THAT(i.motion.axis[0].estimate->value, WithinAbs(-2e-3, 2e-3));
  CHECK_THAT(i.motion.axis[1].estimate->value, WithinAbs(13e-3, 1e-3));
  CHECK_THAT(i.motion.path_radius.estimate->value, WithinAbs(230e-3, 1.5e-3));
  REQUIRE(i.flight.angle_degrees.estimate);
  CHECK(holds(i.flight.angle_degrees, 0));
  CHECK_THAT(i.flight.magnitude.estimate->value, WithinRel(9.81, 0.04));
  CHECK(i.circulations.count > 80);
  CHECK_THAT(i.coverage.covered, WithinAbs(92, 5));
}

TEST_CASE("known mill: the intervals over thirty recordings hold the truth") {
  if (absent("mill10_A_75_1.a")) return;
  int said = 0, inside[4] = {}, axis = 0, all = 0;
  for (const char set : {'A', 'B'}) {
    for (const int percent : {75, 60, 50}) {
      const double speed = 42.3 / std::sqrt(0.290) * percent / 100 / kRpm;
      for (int run = 1; run <= 5; ++run) {
        const inspect::MillMotion m =
            inspect::estimate_motion(recording::read_recording(testing::recording(fmt::format("mill10_{}_{}_{}.a", set, percent, run))));
        REQUIRE(m.sense == -1);
        ++all;
        axis += holds(m.axis[0], 1.4e-3) && holds(m.axis[1], -0.9e-3);
        if (m.path_radius.bound == inspect::Bound::at_least) {
          CHECK(m.path_radius.estimate->low < 145e-3);
          CHECK(m.speed.estimate->low < speed);
          continue;
        }
        ++said;
        CHECK_THAT(m.speed.estimate->value, WithinRel(speed, 0.015));
        CHECK_THAT(m.path_radius.estimate->value, WithinAbs(145e-3, 1.5e-3));
        inside[0] += holds(m.axis[0], 1.4e-3);
        inside[1] += holds(m.axis[1], -0.9e-3);
        inside[2] += holds(m.path_radius, 145e-3);
        inside[3] += holds(m.speed, speed);
      }
    }
  }
  CHECK(said >= 18);
  CHECK(axis >= all * 7 / 10);
  for (const int count : inside) CHECK(count >= said * 8 / 10);
}
