// Axis, speed, radius, vertical, circulations and losses of a mill that is known.
#include <catch2/catch.hpp>
#include <cmath>

#include "inspect/synthetic.hpp"
#include "studies/inspect/inspect.hpp"

using namespace millscope;
using test::SyntheticMill;

namespace {

bool holds(const inspect::Finding& f, double truth) { return f.estimate && f.estimate->low <= truth && truth <= f.estimate->high; }

}  // namespace

TEST_CASE("the intervals of axis, speed and radius hold the truth about nine times in ten") {
  int inside[4] = {}, all = 0;
  for (std::uint64_t seed = 1; seed <= 14; ++seed) {
    SyntheticMill mill;
    mill.seed = seed;
    mill.seconds = 40;
    const inspect::MillMotion m = inspect::estimate_motion(make_recording(mill));
    REQUIRE(m.sense == -1);
    CHECK(m.path_radius.bound == inspect::Bound::both);
    CHECK(std::fabs(m.axis[0].estimate->value - mill.axis[0]) < 1e-3);
    CHECK(std::fabs(m.axis[1].estimate->value - mill.axis[1]) < 1e-3);
    CHECK(std::fabs(m.path_radius.estimate->value - mill.radius) < 1e-3);
    inside[0] += holds(m.axis[0], mill.axis[0]);
    inside[1] += holds(m.axis[1], mill.axis[1]);
    inside[2] += holds(m.path_radius, mill.radius);
    inside[3] += holds(m.speed, 6);
    ++all;
  }
  for (const int count : inside) CHECK(count >= all - 4);
}

TEST_CASE("where the axis is known the rides are those of an axis that has to be found") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SyntheticMill away, there;
    away.seed = there.seed = seed;
    there.axis = {0, 0};
    const inspect::MillMotion m = inspect::estimate_motion(make_recording(away));
    const auto axis = inspect::axis_by_rides(make_recording(there), m.path_radius.estimate->value, away.angular_velocity, m.noise);
    REQUIRE(axis);
    for (std::size_t i = 0; i < 2; ++i) CHECK(std::fabs(m.axis[i].estimate->value - away.axis[i] - (*axis)[i]) < 3e-5);
    CHECK(m.axis_scatter[0] > 0);
  }
}

TEST_CASE("a mill that turns the other way is told from its mirror image") {
  SyntheticMill mill;
  mill.angular_velocity = 4;
  mill.radius = 0.23;
  const inspect::MillMotion m = inspect::estimate_motion(make_recording(mill));
  CHECK(m.sense == 1);
  CHECK_THAT(m.angular_velocity(), Catch::Matchers::WithinRel(4, 0.01));
  CHECK_THAT(m.path_radius.estimate->value, Catch::Matchers::WithinAbs(0.23, 1e-3));
}

TEST_CASE("gravity is found in flight, also when the camera is turned") {
  for (const double degrees : {0.0, -6.0, 12.0}) {
    SyntheticMill mill;
    mill.gravity_degrees = degrees;
    const inspect::FreeFlight f = inspect::measure_flight(make_recording(mill));
    REQUIRE(f.angle_degrees.estimate);
    CHECK_THAT(f.angle_degrees.estimate->value, Catch::Matchers::WithinAbs(degrees, 1));
    CHECK(holds(f.angle_degrees, degrees));
    CHECK(holds(f.axial_degrees, 0));
    CHECK_THAT(f.magnitude.estimate->value, Catch::Matchers::WithinRel(9.81, 0.02));
    CHECK(f.flights > 10);
  }
}

TEST_CASE("noise comes from the points") {
  for (const double noise : {0.3e-3, 1.0e-3}) {
    SyntheticMill mill;
    mill.noise = noise;
    for (const inspect::Finding& f : inspect::measure_noise(make_recording(mill)))
      CHECK_THAT(f.estimate->value, Catch::Matchers::WithinRel(noise, 0.12));
  }
}

TEST_CASE("locations of fast beads that are lost are missed by their rate") {
  SyntheticMill mill;
  mill.seconds = 120;
  mill.fast = 1.2;
  mill.lost_when_fast = 0.5;
  const recording::Recording recording = make_recording(mill);
  const inspect::Losses lossy = inspect::inspect(recording).losses;
  REQUIRE(lossy.ranges.size() == 7);
  CHECK_THAT(lossy.ranges.back().lost.value, Catch::Matchers::WithinAbs(0.5, 0.12));
  CHECK(lossy.ranges[3].lost.value < 0.15);
  mill.lost_when_fast = 0;
  const inspect::Losses whole = inspect::inspect(make_recording(mill)).losses;
  CHECK(whole.ranges.back().lost.value < 0.12);
  CHECK(whole.missed_falling.estimate->value < 0.08);
}

TEST_CASE("circulations are counted, and their time follows the motion") {
  SyntheticMill mill;
  const recording::Recording recording = make_recording(mill);
  const inspect::Inspection i = inspect::inspect(recording);
  CHECK(i.circulations.count > 60);
  CHECK_THAT(static_cast<double>(i.circulations.count) * i.circulations.time.estimate->value,
             Catch::Matchers::WithinRel(mill.seconds, 0.1));
  CHECK(i.circulations.per_turn.estimate->value > 1);
  REQUIRE(i.mean_offset.estimate);
  CHECK(i.mean_offset.estimate->value < 0);  // the charge hangs on the rising side
}

TEST_CASE("the interval of the mean beside the axis shrinks with the recording's length") {
  SyntheticMill mill;
  mill.seconds = 30;
  const millscope::base::Interval90 brief = *inspect::inspect(make_recording(mill)).mean_offset.estimate;
  mill.seconds = 270;
  const millscope::base::Interval90 lasting = *inspect::inspect(make_recording(mill)).mean_offset.estimate;
  CHECK(lasting.high - lasting.low < 0.6 * (brief.high - brief.low));
  CHECK(lasting.value > brief.low);
  CHECK(lasting.value < brief.high);
}

TEST_CASE("a charge that slips gives a bound on the speed, not the speed") {
  SyntheticMill mill;
  mill.slip = 0.4;
  const inspect::MillMotion m = inspect::estimate_motion(make_recording(mill));
  REQUIRE(m.speed.estimate);
  CHECK(m.speed.bound == inspect::Bound::at_least);
  CHECK(m.speed.estimate->low < 6);
  CHECK(std::isinf(m.speed.estimate->high));
}

TEST_CASE("a tracer that never touches the shell gives a bound on its radius") {
  SyntheticMill mill;
  mill.at_shell = 0;
  const inspect::MillMotion m = inspect::estimate_motion(make_recording(mill));
  REQUIRE(m.path_radius.estimate);
  CHECK(m.path_radius.bound == inspect::Bound::at_least);
  CHECK(m.path_radius.estimate->low < 0.145);
}

TEST_CASE("several runs are read as one recording") {
  SyntheticMill mill;
  mill.seconds = 20;
  recording::Recording recording = make_recording(mill);
  const double alone = recording.runs[0].time.back() - recording.runs[0].time.front();
  const std::size_t rides = inspect::estimate_motion(recording).rides;
  mill.seed = 2;
  recording.runs.push_back(make_recording(mill).runs[0]);
  CHECK(inspect::estimate_motion(recording).rides > rides + rides / 2);
  const inspect::Coverage c = inspect::measure_coverage(recording);
  CHECK(c.runs == 2);
  CHECK_THAT(c.span, Catch::Matchers::WithinRel(2 * alone, 0.01));
}
