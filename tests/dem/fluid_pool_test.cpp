// Beads in a pool of liquid: fall, float, dive in, and the energy that the liquid takes.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

/// One bead of this density under gravity and a pool of water with its surface at y = 0; 10 µs steps.
Assembly one_bead(double density, const Vector& position, const Vector& velocity) {
  Setup s;
  s.body_forces = "{gravity: {kind: gravity}, pool: {kind: fluid_pool, level: 0 m}}";
  s.time = "{end_s: 100, step_s: 1e-5}";
  s.run = "{partitions: 1, allow_unstable: true}";
  Assembly a = assembled(s);
  Bead b;
  b.position = position;
  b.velocity = velocity;
  b.density = density;
  start(a, {b});
  return a;
}

/// Fluid that moves with a bead at this height, kg.
double added_mass(double y) {
  const double depth = std::min(std::max(kRadius - y, 0.0), 2 * kRadius);
  return 0.5 * 1000 * std::numbers::pi / 3 * depth * depth * (3 * kRadius - depth);
}

}  // namespace

TEST_CASE("a glass bead sinks in water at the speed at which drag carries its submerged weight") {
  Assembly a = one_bead(kDensity, {0, -0.5, 0}, {});
  advance(a, 100000);
  // Re = 2360 is above 800, where C_d is the larger of 0.44 and Schiller and Naumann's 0.34.
  CHECK(velocity(a, 0)[1] == Approx(-std::sqrt(4.0 / 3.0 * kGravity * 2 * kRadius * (kDensity / 1000 - 1) / 0.44)).epsilon(1e-5));  // 0.472
}

TEST_CASE("a bead of the density of water hovers, a lighter one floats where theory says") {
  Assembly still = one_bead(1000, {0, -0.1, 0}, {});
  for (dem::MotionLine& line : still.system->particles.half) line.v[1] = 0;  // half a step of free fall was taken for granted
  advance(still, 20000);
  CHECK(position(still, 0)[1] == Approx(-0.1).margin(1e-9));
  Assembly floating = one_bead(500, {0, 0.2 * kRadius, 0}, {});
  advance(floating, 1000000);
  CHECK(position(floating, 0)[1] == Approx(0.0).margin(0.01 * kRadius));
}

TEST_CASE("submerged glass falls from rest with the acceleration that added mass leaves") {
  Assembly a = one_bead(kDensity, {0, -0.1, 0}, {});
  for (dem::MotionLine& line : a.system->particles.half) line.v[1] = 0;
  advance(a, 100);
  CHECK(velocity(a, 0)[1] == Approx(-kGravity * (kDensity - 1000) / (kDensity + 500) * 1e-3).epsilon(2e-3));
}

TEST_CASE("a bead that dives in and one that leaps out lose what the ledger says, the moving liquid counted") {
  for (const Vector& v : {Vector{0.7, -2, 0}, Vector{0.2, 2.5, 0.1}}) {
    const Vector from{0, v[1] < 0 ? 0.01 : -0.01, 0};
    Assembly a = one_bead(kDensity, from, v);
    const auto liquid = [&a] {
      const Vector u = velocity(a, 0);
      return 0.5 * added_mass(position(a, 0)[1]) * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    };
    const double liquid_first = liquid();
    const Energy first = observed(a);
    advance(a, 2500);
    const double liquid_last = liquid();
    const Energy last = observed(a);
    const double kept = last.stored() + liquid_last - first.stored() - liquid_first;
    INFO("from y = " << from[1] << " to " << position(a, 0)[1] << ", lost " << last.dissipated << " J, kept " << kept << " J");
    CHECK(from[1] * position(a, 0)[1] < 0);
    CHECK(last.dissipated > 0);
    CHECK(last.dissipated - first.dissipated == Approx(-kept).epsilon(2e-3));
  }
}

TEST_CASE("a charge shaken in a pool keeps its book within 1 %") {
  Setup s;
  s.pairs = "restitution: 0.8, static_friction: 0.34";
  s.wall_pairs = "restitution: 0.55, static_friction: 0.30";
  s.body_forces = "{gravity: {kind: gravity}, pool: {kind: fluid_pool, level: 20 mm}}";
  const Book book = shaken_box(s);
  INFO("input " << book.input << " J, lost " << book.lost << " J, kept " << book.kept << " J");
  CHECK(book.input > 0.01);
  CHECK(std::fabs(book.input - book.lost - book.kept) < 0.01 * book.input);
}
