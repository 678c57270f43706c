// One sphere that slides and rolls over a plane, level or inclined.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

/// A sphere that rests on the floor; gravity is turned by `slope`, so that +x leads downhill.
Assembly on_slope(Setup s, double friction, double slope, const Vector& velocity = {}, const Vector& spin = {}) {
  s.pairs = fmt::format("restitution: 0.5, static_friction: {}, rolling_friction: 0.02", friction);
  if (s.interactions == "{}") s.pairs = fmt::format("restitution: 0.5, static_friction: {}", friction);
  s.geometry = kFloor;
  s.body_forces = fmt::format("{{gravity: {{kind: gravity, direction: [{:.17g}, {:.17g}, 0]}}}}", std::sin(slope), -std::cos(slope));
  Assembly a = assembled(s);
  Bead b;
  b.position = {0, kRadius - resting_overlap(s.stiffness_factor, slope), 0};
  b.velocity = velocity;
  b.spin = spin;
  start(a, {b});
  return a;
}

double surface_speed(const Assembly& a) { return velocity(a, 0)[0] + kRadius * spin(a, 0)[2]; }

}  // namespace

TEST_CASE("a sliding sphere begins to roll after 2 v0/(7 mu g) at 5/7 of its speed") {
  for (const char* law : {"{kind: hertz_mindlin}", "{kind: hertz_mindlin_deresiewicz}", "{kind: hertz_mindlin, cap: sum}"}) {
    INFO(law);
    Setup s;
    s.law = law;
    const double v0 = 0.5, mu = 0.2, sliding = 2 * v0 / (7 * mu * kGravity);
    Assembly a = on_slope(s, mu, 0, {v0, 0, 0});
    const std::int64_t half = std::llround(0.5 * sliding / a.time_step);
    advance(a, half);
    CHECK(velocity(a, 0)[0] == Approx(v0 - mu * kGravity * (static_cast<double>(half) - 0.5) * a.time_step).epsilon(1e-3));
    while (surface_speed(a) > 0) a.system->advance();
    CHECK(a.system->time() == Approx(sliding).epsilon(5e-3));
    advance(a, half);
    CHECK(velocity(a, 0)[0] == Approx(5.0 / 7.0 * v0).epsilon(2e-3));
    CHECK(surface_speed(a) == Approx(0).margin(1e-3 * v0));
    CHECK(velocity(a, 0)[1] == Approx(0).margin(1e-4));
  }
}

TEST_CASE("down a gentle slope a sphere rolls with 5/7 g sin, down a steep one it slides") {
  const auto speed_after = [](double friction, double slope, double time) {
    Assembly a = on_slope(Setup{}, friction, slope);
    advance(a, std::llround(time / a.time_step));
    return velocity(a, 0)[0] / (a.system->time() - 0.5 * a.time_step);
  };
  const double mu = 0.2, gentle = 0.3, steep = 0.8;  // tan 0.3 = 0.31 < 7/2 μ = 0.7 < tan 0.8 = 1.03
  CHECK(speed_after(mu, gentle, 0.1) == Approx(5.0 / 7.0 * kGravity * std::sin(gentle)).epsilon(3e-3));
  CHECK(speed_after(mu, steep, 0.1) == Approx(kGravity * (std::sin(steep) - mu * std::cos(steep))).epsilon(3e-3));
}

TEST_CASE("rolling friction stops a rolling sphere within 7 v0^2/(10 mu_r g)") {
  for (const char* kind : {"rolling_constant_torque", "rolling_epsd"}) {
    INFO(kind);
    Setup s;
    s.interactions = fmt::format("{{rolling: {{kind: {}}}}}", kind);
    const double v0 = 0.2;
    Assembly a = on_slope(s, 0.5, 0, {v0, 0, 0}, {0, 0, -v0 / kRadius});
    // M = μ_r R F_n about the contact, 7/5 m R² of inertia there.
    const double distance = 0.7 * v0 * v0 / (0.02 * kGravity), time = 2 * distance / v0;
    advance(a, std::llround(0.5 * time / a.time_step));
    CHECK(velocity(a, 0)[0] == Approx(0.5 * v0).epsilon(0.01));
    advance(a, std::llround(1.0 * time / a.time_step));
    CHECK(position(a, 0)[0] == Approx(distance).epsilon(0.01));
    CHECK(std::abs(velocity(a, 0)[0]) < 0.01 * v0);
    const dem::Ledger ledger = a.system->ledger();
    double rolling = 0;
    for (std::size_t c = 0; c < a.system->layout().channels.size(); ++c) {
      if (a.system->layout().channels[c].find("rolling.") == 0) rolling += ledger.pairs[1].dissipated[c];
    }
    CHECK(rolling == Approx(0.7 * bead_mass() * v0 * v0).epsilon(0.01));
  }
}

TEST_CASE("with rolling resistance a sphere rests on a slope below mu_r, and rolls on a steeper one") {
  for (const char* kind : {"rolling_constant_torque", "rolling_epsd"}) {
    Setup s;
    s.interactions = fmt::format("{{rolling: {{kind: {}, {}}}}}", kind, kind[8] == 'e' ? "damping_ratio: 0.3" : "spin: relative");
    Assembly below = on_slope(s, 0.5, std::atan(0.01)), above = on_slope(s, 0.5, std::atan(0.04));
    const std::int64_t steps = std::llround(0.3 / below.time_step);
    advance(below, steps);
    advance(above, steps);
    const double downhill = 5.0 / 7.0 * kGravity * (std::sin(std::atan(0.04)) - 0.02 * std::cos(std::atan(0.04)));
    INFO(kind << ": creeps at " << velocity(below, 0)[0]);
    CHECK(velocity(above, 0)[0] == Approx(downhill * 0.3).epsilon(0.02));
    CHECK(std::abs(velocity(below, 0)[0]) < 0.02 * velocity(above, 0)[0]);
  }
}

TEST_CASE("a bead of another shape rolls until its energy is lost by tipping over, and rocks at rest") {
  const double alpha = 1.1, a = std::pow(alpha, 2.0 / 3), b = std::pow(alpha, -1.0 / 3), v0 = 0.2;
  const double stiffness = b * (alpha * alpha - 1), limit = (a - b) / M_PI;  // k_r and M_max over R F_n
  Setup s;
  s.interactions = "{rolling: {kind: bead_shape}}";
  s.pairs = "restitution: 0.5, static_friction: 0.5, aspect_ratio: 1.1";
  s.body_forces = "{gravity: {kind: gravity}}";
  s.geometry = kFloor;
  const auto resting = [&](double speed) {
    Assembly assembly = assembled(s);
    Bead bead;
    bead.position = {0, kRadius - resting_overlap(s.stiffness_factor), 0};
    bead.velocity = {speed, 0, 0};
    bead.spin = {0, 0, -speed / kRadius};
    start(assembly, {bead});
    return assembly;
  };
  // 7/10 m v0^2 = M_max (s/R - M_max/(2 k_r)): the last part is kept by the spring.
  Assembly rolling = resting(v0);
  while (velocity(rolling, 0)[0] > 0) rolling.system->advance();
  const double angle = 0.7 * v0 * v0 / (limit * kGravity * kRadius) + 0.5 * limit / stiffness;
  CHECK(position(rolling, 0)[0] == Approx(angle * kRadius).epsilon(0.01));
  // 7/5 m R^2 phi'' = -k_r phi.
  Assembly rocking = resting(0.1 * limit / stiffness * std::sqrt(stiffness * kGravity * kRadius / 1.4));
  const double quarter = 0.5 * M_PI / std::sqrt(stiffness * kGravity / (1.4 * kRadius));
  while (velocity(rocking, 0)[0] > 0) rocking.system->advance();
  CHECK(rocking.system->time() == Approx(quarter).epsilon(0.01));
}
