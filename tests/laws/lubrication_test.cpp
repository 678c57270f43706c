// A viscous film: the formula, its cuts, and what it takes.
#include <catch2/catch.hpp>

#include "laws/one_pair.hpp"

using namespace laws_test;

namespace {

constexpr double kPi = 3.14159265358979323846, kEffective = 2.5e-3, kTiny = 1e-12;

/// Force at a gap on two beads that part at this speed.
double force(double gap, double speed, const std::string& text, double time_step = kTiny) {
  OnePair p;
  p.overlap[0] = -gap;
  p.velocity[0][0] = speed;
  p.velocity[1][0] = 3.0;  // sliding does not count
  p.batch.time_step = time_step;
  p.evaluate("lubrication", text);
  CHECK(p.batch.power_sum[0] == Approx(-p.added_force[0] * speed));
  CHECK(p.batch.power_sum[0] >= 0.0);
  CHECK(p.added_cap[0] == 0.0);
  return p.added_force[0];
}

}  // namespace

TEST_CASE("the film resists with 6 pi mu R*^2 v/h, cut at the roughness, none at its range and in contact") {
  const std::string text = "viscosity=0.05 cut=0.01 range=0.2";
  const double least = 0.01 * kEffective, range = 0.2 * kEffective, front = 6 * kPi * 0.05 * kEffective * kEffective;
  for (const double gap : {least, 2 * least, 10 * least, 0.999 * range}) {
    CHECK(force(gap, -0.3, text) == Approx(front * 0.3 * (1 / gap - 1 / range)));
    CHECK(force(gap, 0.3, text) == -force(gap, -0.3, text));
  }
  CHECK(force(0.1 * least, -0.3, text) == Approx(force(least, -0.3, text)));
  for (const double gap : {-1e-6, 1.001 * range}) CHECK(force(gap, -0.3, text) == 0.0);
  CHECK(force(10 * least, 0.0, text) == 0.0);
  CHECK(force(10 * least, -0.3, "viscosity=0") == 0.0);
}

TEST_CASE("what the film takes from a passing bead does not depend on the time step") {
  // Sum of F dt over the way from the range to the touch at constant speed: 6 pi mu R*^2 ln(H/h_min).
  const double cut = 1e-3, range = 0.25, speed = 0.5, front = 6 * kPi * 0.01 * kEffective * kEffective;
  for (const double time_step : {2e-4, 2e-5, 1e-6}) {
    double impulse = 0;
    for (double gap = range * kEffective - 0.5 * speed * time_step; gap > -speed * time_step; gap -= speed * time_step) {
      impulse += force(gap, -speed, "viscosity=0.01", time_step) * time_step;
    }
    INFO("time step " << time_step);
    CHECK(impulse == Approx(front * std::log(range / cut)).epsilon(2e-4));
  }
}

TEST_CASE("the stiffest film takes half of the speed in a step") {
  const double mass = 1e-3, time_step = 1e-4;  // of OnePair
  CHECK(force(1e-7, -0.01, "viscosity=100 cut=1e-6", time_step) * time_step / mass == Approx(0.5 * 0.01));
}
