// Oblique impacts on a wall against rigid-body theory, Maw, Barber & Fawcett (1976) and Kharaz, Gorham & Salman (2001).
#include <catch2/catch.hpp>

#include "laws/two_bodies.hpp"

using namespace laws_test;

namespace {

constexpr double kPi = 3.14159265358979;

struct Rebound {
  double tangential, normal, spin;
};

/// A bead that hits a wall (normal +x) at this angle from the normal, without spin.
Rebound hit(const Law& law, double radius, double density, double speed, double angle, double dt) {
  Body a = bead(radius, density);
  a.position = {radius + 1e-8, 0, 0};
  a.velocity = {-speed * std::cos(angle), speed * std::sin(angle), 0};
  Collision c(law, a, fixed_wall());
  c.run(dt);
  return {c.i().half_velocity[1], c.i().half_velocity[0], c.i().half_spin[2]};
}

PairContext wall_pair(double young, double poisson, double radius, double density) {
  PairContext pair = bead_pair(radius, young, poisson, density);
  pair.smallest_radius = pair.largest_radius = radius;
  pair.smallest_mass = pair.largest_mass = bead(radius, density).mass;
  pair.with_wall = 1;
  return pair;
}

}  // namespace

TEST_CASE("an impact that slides throughout follows rigid-body theory exactly") {
  // Δv_t = −μ (1 + e) v_n, spin = 5/2 μ (1 + e) v_n/R while tan θ > 7/2 μ (1 + e).
  for (const char* text : {"", " cap=sum", " tangential=mindlin_deresiewicz", " tangential=mindlin_deresiewicz cap=sum"}) {
    const Law law =
        make_law("hertz_mindlin", "restitution=0.9 static_friction=0.1" + std::string(text), wall_pair(63.96e6, 0.23, 5e-3, 2500));
    for (const double degrees : {60.0, 75.0}) {
      const double angle = degrees * kPi / 180, normal = std::cos(angle), change = 0.1 * 1.9 * normal;
      const Rebound r = hit(law, 5e-3, 2500, 1.0, angle, 1e-7);
      INFO(text << " " << degrees);
      CHECK(r.normal == Approx(0.9 * normal).epsilon(0.005));
      // Friction never pulls, damping does in the last moments: the compressive impulse is a little more than (1 + e) m v_n.
      CHECK(std::sin(angle) - r.tangential == Approx(change).epsilon(0.02));
      CHECK(std::fabs(r.spin) * 5e-3 == Approx(2.5 * change).epsilon(0.02));
    }
  }
}

TEST_CASE("without damping the impulse of sliding is exact to the time step") {
  const Law law = make_law("hertz_mindlin", "restitution=1 static_friction=0.1", wall_pair(63.96e6, 0.23, 5e-3, 2500));
  const double angle = 70 * kPi / 180;
  const Rebound r = hit(law, 5e-3, 2500, 1.0, angle, 1e-7);
  CHECK(std::sin(angle) - r.tangential == Approx(0.2 * std::cos(angle)).epsilon(1e-3));
}

TEST_CASE("between sticking and sliding the surface of the bead reverses, as Maw, Barber & Fawcett (1976) found") {
  // ψ = 2 (1 − ν)/(μ (2 − ν)) v_t/v_n of the contact point: ψ₂ falls from zero to about −1.2 near ψ₁ = 4, and rises along ψ₁ − 7·0.87 when
  // the bead slides throughout, ψ₁ > 7·0.87 = 6.1.
  const PairContext pair = wall_pair(63.96e6, 0.23, 5e-3, 2500);
  const double scale = 4.0 * pair.effective_shear / pair.effective_young / 0.4;
  CHECK(scale == Approx(2 * 0.77 / (0.4 * 1.77)).epsilon(1e-9));
  for (const char* text : {"", " tangential=mindlin_deresiewicz"}) {
    const Law law = make_law("hertz_mindlin", "restitution=1 static_friction=0.4" + std::string(text), pair);
    const auto rebound = [&](double psi) {
      const double angle = std::atan(psi / scale);
      const Rebound r = hit(law, 5e-3, 2500, 1.0, angle, 1e-7);
      return scale * (r.tangential - 5e-3 * r.spin) / r.normal;
    };
    INFO(text);
    CHECK(rebound(1.8) < 0.0);
    CHECK(rebound(3.8) < -1.0);
    CHECK(rebound(3.8) > -2.0);
    CHECK(rebound(8.0) == Approx(8.0 - 7.0 * scale * 0.4).margin(0.06));
  }
}

TEST_CASE("5 mm alumina on glass: the sliding line of Kharaz, Gorham & Salman 2001") {
  // They fit their rebounds at 3.9 m/s with e_n = 0.98 and μ = 0.092: e_t = 1 − μ (1 + e_n)/tan θ beyond tan θ = 7/2 μ (1 + e_n), 32.5°.
  PairContext pair = wall_pair(70e9, 0.25, 2.5e-3, 4000);
  const double alumina = 380e9, glass = 70e9;
  pair.effective_young = 1.0 / ((1 - 0.23 * 0.23) / alumina + (1 - 0.25 * 0.25) / glass);
  pair.effective_shear = 1.0 / ((2 - 0.23) * 2 * 1.23 / alumina + (2 - 0.25) * 2 * 1.25 / glass);
  const Law law = make_law("hertz_mindlin", "restitution=0.98 static_friction=0.092", pair);
  for (const double degrees : {40.0, 50.0, 60.0, 70.0, 80.0}) {
    const double angle = degrees * kPi / 180;
    const Rebound r = hit(law, 2.5e-3, 4000, 3.9, angle, 5e-9);
    INFO(degrees);
    CHECK(r.tangential / (3.9 * std::sin(angle)) == Approx(1.0 - 0.092 * 1.98 / std::tan(angle)).margin(0.01));
    CHECK(std::fabs(r.spin) * 2.5e-3 == Approx(2.5 * 0.092 * 1.98 * 3.9 * std::cos(angle)).epsilon(0.03));
  }
  const double angle = 20 * kPi / 180;  // sticking: e_t leaves the line
  CHECK(hit(law, 2.5e-3, 4000, 3.9, angle, 5e-9).tangential / (3.9 * std::sin(angle)) > 1.0 - 0.092 * 1.98 / std::tan(angle) + 0.02);
}
