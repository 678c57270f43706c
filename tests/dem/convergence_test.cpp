// The order in which the error falls with the time step.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

constexpr int kSamples = 20;

/// A sphere pressed a quarter too deep into a plane that slopes a little swings up and down, and sideways on its tangential spring.
std::vector<Vector> swing(const char* law, const char* pairs, int steps) {
  Setup s;
  s.law = law;
  s.pairs = pairs;
  s.geometry = kFloor;
  s.body_forces = "{gravity: {kind: gravity, magnitude: 200, direction: [0.3, -1, 0.1]}}";
  s.time = fmt::format("{{end_s: 100, step_s: {:.17g}}}", 2e-3 / steps);
  s.run = "{partitions: 1, allow_unstable: true}";
  Assembly a = assembled(s);
  const double weight = bead_mass() * 200 / std::sqrt(1.1);
  Bead b;
  const double hertz = std::pow(0.75 * weight / (effective_young(s.stiffness_factor) * std::sqrt(kRadius)), 2.0 / 3.0);
  b.position = {0, kRadius - 1.25 * (std::string(law).find("linear") == std::string::npos ? hertz : weight / 20000), 0};
  start_in_contact(a, {b});
  std::vector<Vector> path;
  for (int k = 0; k < kSamples; ++k) {
    advance(a, steps / kSamples);
    path.push_back(position(a, 0));
  }
  return path;
}

/// Largest error on the way, per axis.
Vector error(const std::vector<Vector>& path, const std::vector<Vector>& reference) {
  Vector worst{};
  for (std::size_t k = 0; k < path.size(); ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) worst[axis] = std::max(worst[axis], std::abs(path[k][axis] - reference[k][axis]));
  }
  return worst;
}

}  // namespace

TEST_CASE("a smooth contact is followed to second order") {
  struct {
    const char* law;
    const char* pairs;
  } const cases[] = {{"{kind: hertz_mindlin}", "restitution: 1, static_friction: 50"},
                     {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 50"},
                     {"{kind: linear_spring_dashpot}", "restitution: 1, static_friction: 50, normal_stiffness: 20000 N/m"},
                     {"{kind: linear_spring_dashpot}", "restitution: 0.7, static_friction: 50, normal_stiffness: 20000 N/m"},
                     {"{kind: jkr}", "restitution: 0.7, static_friction: 50, surface_energy: 0.02 J/m^2"}};
  for (const auto& c : cases) {
    const std::vector<Vector> reference = swing(c.law, c.pairs, 40000);
    const Vector coarse = error(swing(c.law, c.pairs, 400), reference), fine = error(swing(c.law, c.pairs, 800), reference);
    for (const std::size_t axis : {0U, 1U, 2U}) {
      INFO(c.law << ' ' << c.pairs << ", axis " << axis << ", errors " << coarse[axis] << ", " << fine[axis]);
      CHECK(fine[axis] > 1e-13);  // not yet rounding
      CHECK(std::log2(coarse[axis] / fine[axis]) > 1.9);
    }
  }
}

// A collision begins with a kink: the damping force ∝ δ^{1/4} v jumps up within the step of the first touch.
TEST_CASE("the restitution of a whole collision converges with order 1 or better") {
  const auto error = [](double fraction, double e) {
    double sum = 0;
    for (double phase = 0.05; phase < 1; phase += 0.1) {
      Setup s;
      s.pairs = fmt::format("restitution: {}, static_friction: 0", e);
      s.time = fmt::format("{{end_s: 100, step_fraction: {}}}", fraction);
      s.geometry = kFloor;
      Assembly a = assembled(s);
      Bead b;
      b.position = {0, kRadius + (1 + phase) * a.time_step, 0};
      b.velocity = {0, -1, 0};
      start(a, {b});
      while (position(a, 0)[1] < kRadius || velocity(a, 0)[1] < 0) a.system->advance();
      sum += (velocity(a, 0)[1] / e - 1) * (velocity(a, 0)[1] / e - 1);
    }
    return std::sqrt(sum / 10);
  };
  for (const double e : {0.5, 0.8, 1.0}) {
    const double coarse = error(0.1, e), fine = error(0.0125, e), p = std::log2(coarse / fine) / 3;
    INFO("e = " << e << ": error " << coarse << " at 10 % of the Rayleigh time, order " << p);
    CHECK(p > 1);
    CHECK(coarse < 0.01);
  }
}
