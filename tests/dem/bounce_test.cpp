// One sphere and a plane: restitution, time of contact, oblique impact.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

struct Bounce {
  double restitution = 0, contact_time = 0;
  Vector velocity{}, spin{};
};

/// A sphere meets the floor; `phase` (0…1) of a step: where in a step it first touches.
Bounce bounce(Setup setup, const Vector& impact, const Vector& impact_spin = {}, double phase = 0.5) {
  setup.geometry = kFloor;
  Assembly a = assembled(setup);
  Bead b;
  b.position = {0, kRadius - (2 + phase) * a.time_step * impact[1], 0};
  b.velocity = impact;
  b.spin = impact_spin;
  start(a, {b});
  std::int64_t touching = 0;
  for (std::int64_t step = 0; step < 4'000'000; ++step) {
    a.system->advance();
    if (a.system->ledger().pairs[1].contacts > 0) {
      ++touching;
    } else if (touching > 0) {
      break;
    }
  }
  return {-velocity(a, 0)[1] / impact[1], static_cast<double>(touching) * a.time_step, velocity(a, 0), spin(a, 0)};
}

std::string pair_of(double restitution, double friction = 0.3) {
  return fmt::format("restitution: {}, static_friction: {}", restitution, friction);
}

/// The two spring laws; the linear one takes its stiffness (N/m) from the pair.
struct SpringLaw {
  const char* law;
  const char* of_pair;
};
constexpr SpringLaw kSpringLaws[] = {{"{kind: hertz_mindlin}", ""}, {"{kind: linear_spring_dashpot}", ", normal_stiffness: 20000 N/m"}};

}  // namespace

TEST_CASE("a sphere bounces off a plane with the nominal restitution") {
  Setup s;
  s.time = "{end_s: 100, step_fraction: 0.005}";
  for (const SpringLaw& law : kSpringLaws) {
    s.law = law.law;
    for (const double e : {0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95}) {
      s.pairs = pair_of(e) + law.of_pair;
      for (const double speed : {0.1, 1.0}) {
        INFO(law.law << ", e = " << e << ", v = " << speed);
        CHECK(bounce(s, {0, -speed, 0}).restitution == Approx(e).epsilon(0.005));
      }
    }
  }
}

// Seventeen steps in a contact; the force sets in with a kink somewhere in the first of them.
TEST_CASE("at 20 % of the Rayleigh time the restitution is right within 1 % for e of 0.55 and more") {
  Setup s;
  constexpr std::pair<double, double> kBounds[] = {{0.3, 0.06}, {0.55, 0.01}, {0.8, 0.0065}, {0.95, 0.003}};
  for (const auto& [e, bound] : kBounds) {
    s.pairs = pair_of(e);
    double worst = 0;
    for (double phase = 0.05; phase < 1; phase += 0.05) {
      worst = std::max(worst, std::abs(bounce(s, {0, -1, 0}, {}, phase).restitution / e - 1));
    }
    INFO("e = " << e);
    CHECK(worst < bound);
  }
}

TEST_CASE("a contact lasts as long as theory says") {
  Setup s;
  s.time = "{end_s: 100, step_fraction: 0.002}";
  s.pairs = pair_of(1.0);
  const double young = effective_young(s.stiffness_factor), m = bead_mass();
  for (const double speed : {0.1, 1.0}) {
    const double hertz = 2.8683 * std::pow(m * m / (kRadius * young * young * speed), 0.2);
    CHECK(bounce(s, {0, -speed, 0}).contact_time == Approx(hertz).epsilon(0.003));
  }
  s.law = kSpringLaws[1].law;
  for (const double e : {0.3, 0.8}) {
    s.pairs = pair_of(e) + kSpringLaws[1].of_pair;
    const double pi = std::numbers::pi, linear = std::sqrt(m * (pi * pi + std::log(e) * std::log(e)) / 20000);
    CHECK(bounce(s, {0, -1, 0}).contact_time == Approx(linear).epsilon(0.003));
  }
}

// The cap on the sum of spring and damping is Coulomb's law at every instant; a cap on the spring alone lets the damping pull on top
// while the spring still loads.
TEST_CASE("a sphere that slides through the whole impact obeys Coulomb") {
  Setup s;
  s.stiffness_factor = 1;
  s.time = "{end_s: 100, step_fraction: 0.02}";
  const SpringLaw laws[] = {{"{kind: hertz_mindlin, allow_tension: false, cap: sum}", ""},
                            {"{kind: hertz_mindlin_deresiewicz, allow_tension: false, cap: sum}", ""},
                            {"{kind: linear_spring_dashpot, allow_tension: false, cap: sum}", ", normal_stiffness: 1e7 N/m"}};
  for (const SpringLaw& law : laws) {
    s.law = law.law;
    for (const double e : {0.5, 1.0}) {
      const double mu = 0.1, vn = 0.5, vt = 5;
      s.pairs = pair_of(e, mu) + law.of_pair;
      const Bounce b = bounce(s, {vt, -vn, 0});
      INFO(law.law << ", e = " << e);
      // Δv_t = −μ (1 + e) v_n with the restitution that this impact had: without tension it is a little above e.
      const double impulse = mu * (1 + b.restitution) * vn;
      CHECK(b.velocity[0] - vt == Approx(-impulse).epsilon(1e-3));
      // ω = 5/2 Δv_t/R, the lever shortened by half the overlap (0.1 %); sliding along +x turns it clockwise about z.
      CHECK(b.spin[2] == Approx(-2.5 * impulse / kRadius).epsilon(2e-3));
      CHECK(b.velocity[2] == 0.0);
      if (e == 1.0) CHECK(b.restitution == Approx(1).epsilon(1e-3));
    }
  }
}

TEST_CASE("a sphere that sticks gives its slip back when both springs swing together") {
  Setup s;
  s.law = kSpringLaws[1].law;  // k_t/k_n = 2/7: the slip reverses in the time of contact
  s.pairs = pair_of(1.0, 100) + ", normal_stiffness: 1e6 N/m";
  s.time = "{end_s: 100, step_s: 1e-8}";
  const double vt = 0.05, vn = 0.2;
  const Bounce b = bounce(s, {vt, -vn, 0}, {0, 0, 10});
  const double slip = vt + 10 * kRadius;  // of the surface at the floor: v_x + ω_z R
  CHECK(b.velocity[0] + b.spin[2] * kRadius == Approx(-slip).epsilon(5e-3));
  CHECK(b.velocity[0] - vt == Approx(-4.0 / 7.0 * slip).epsilon(5e-3));
  CHECK(b.restitution == Approx(1).epsilon(1e-3));
}
