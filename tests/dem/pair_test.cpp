// Two free spheres, a sphere that adheres, a column of spheres.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

struct Sums {
  Vector momentum{}, angular{};
  double size = 0, angular_size = 0;
};

/// Momentum and angular momentum as leapfrog keeps them: positions at the step, velocities half a step before.
Sums sums(const Assembly& a) {
  Sums s;
  for (std::uint32_t id = 0; id < a.bead_count; ++id) {
    const Vector p = plus({}, mass(a, id), velocity(a, id)), orbit = cross(position(a, id), p);
    s.momentum = plus(s.momentum, 1, p);
    s.angular = plus(plus(s.angular, 1, orbit), inertia(a, id), spin(a, id));
    s.size += length(p);
    s.angular_size += length(orbit) + inertia(a, id) * length(spin(a, id));
  }
  return s;
}

std::vector<Bead> glancing(double radius, double density, int material) {
  Bead a, b;
  a.position = {6e-3, 1e-3, 2e-3};
  a.velocity = {-1, 0.2, -0.1};
  a.spin = {40, -300, 120};
  b.position = {0, 0, 1e-3};
  b.velocity = {0.5, 0.1, 0};
  b.spin = {10, 20, 200};
  b.radius = radius;
  b.density = density;
  b.material = material;
  return {a, b};
}

constexpr const char* kTwoKinds =
    "{light: {material: glass, diameter: 5 mm, share: 50 %}, dense: {material: heavy, diameter: 3 mm, share: 50 %}}";

struct NamedLaw {
  const char* law;
  const char* pairs;
  const char* interactions;
};
constexpr NamedLaw kLaws[] = {
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3", "{}"},
    {"{kind: hertz_mindlin_deresiewicz, cap: sum}", "restitution: 0.7, static_friction: 0.3", "{}"},
    {"{kind: hertz_mindlin, allow_tension: false}", "restitution: 0.7, static_friction: 0.3", "{}"},
    {"{kind: linear_spring_dashpot}", "restitution: 0.7, static_friction: 0.3, normal_stiffness: 20000 N/m", "{}"},
    {"{kind: jkr}", "restitution: 0.7, static_friction: 0.3, surface_energy: 0.05 J/m^2", "{}"},
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3, rolling_friction: 0.05",
     "{rolling: {kind: rolling_constant_torque}}"},
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3, rolling_friction: 0.05",
     "{rolling: {kind: rolling_epsd, damping_ratio: 0.1}}"},
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3, cohesion_energy_density: 1e4 J/m^3",
     "{cohesion: {kind: cohesion_sjkr}}"},
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3, surface_tension: 0.07 N/m", "{bridge: {kind: capillary_bridge}}"},
    {"{kind: hertz_mindlin}", "restitution: 0.7, static_friction: 0.3", "{film: {kind: lubrication, viscosity: 0.02}}"},
};

/// Of the first contact.
struct SeenSpins {
  double normal_x = 0;  ///< above 0: i lies to the right of j
  std::array<double, 3> i{}, j{};
};

const InteractionTable kWatcher{pair_term({}, {}),
                                nullptr,
                                nullptr,
                                [](const void*, double) { return 0.0; },
                                [](const void* self, InteractionBatch* b) {
                                  const auto first = [](const double* const* spin) {
                                    return std::array{spin[0][0], spin[1][0], spin[2][0]};
                                  };
                                  *static_cast<SeenSpins*>(const_cast<void*>(self)) = {b->normal[0][0], first(b->spin_i), first(b->spin_j)};
                                  b->elastic_sum = 0;
                                },
                                nullptr};

}  // namespace

TEST_CASE("an interaction before the law sees the spins of both beads") {
  for (const bool equal : {true, false}) {
    INFO((equal ? "equal" : "unequal"));
    Setup s;
    if (!equal) s.beads = kTwoKinds;
    Assembly a = assembled(s);
    SeenSpins seen;
    std::vector<dem::PairPhysics> physics = a.system->physics();
    for (dem::PairPhysics& p : physics) p.interactions.push_back({&kWatcher, &seen, true, "watcher"});
    a.system = std::make_unique<dem::System>(a.system->settings(), a.system->layout(), physics, 1);
    Bead right, left;
    if (!equal) left.radius = 1.5e-3, left.density = 7800, left.material = 1;
    right.position = {0.999 * (right.radius + left.radius), 0, 0};
    right.spin = {1, 2, 3};
    left.spin = {-4, -5, -6};
    start(a, {right, left});
    a.system->advance();
    REQUIRE(seen.normal_x != 0);
    CHECK((seen.normal_x > 0 ? seen.i : seen.j) == right.spin);
    CHECK((seen.normal_x > 0 ? seen.j : seen.i) == left.spin);
  }
}

TEST_CASE("two free spheres keep momentum and angular momentum, and the ledger knows where the energy went") {
  for (const NamedLaw& law : kLaws) {
    for (const bool equal : {true, false}) {
      INFO(law.law << ' ' << law.interactions << (equal ? ", equal" : ", unequal"));
      Setup s;
      s.law = law.law;
      s.pairs = law.pairs;
      s.interactions = law.interactions;
      if (!equal) s.beads = kTwoKinds;
      s.time = "{end_s: 100, step_fraction: 0.05}";
      Assembly a = assembled(s);
      start(a, equal ? glancing(kRadius, kDensity, 0) : glancing(1.5e-3, 7800, 1));
      const Sums before = sums(a);
      const Energy first = observed(a);
      bool touched = false;
      for (std::int64_t k = 0; k < 4000; ++k) {
        a.system->advance();
        touched = touched || a.system->ledger().pairs[0].contacts + (equal ? 0 : a.system->ledger().pairs[1].contacts) > 0;
        if (k % 100 != 0) continue;
        const Sums now = sums(a);
        REQUIRE(length(minus(now.momentum, before.momentum)) < 1e-12 * before.size);
        REQUIRE(length(minus(now.angular, before.angular)) < 1e-12 * before.angular_size);
      }
      REQUIRE(touched);
      const Energy last = observed(a);
      CHECK(last.dissipated > 0.05 * first.kinetic);
      CHECK(last.stored() + last.dissipated == Approx(first.stored()).epsilon(2e-3));
    }
  }
}

TEST_CASE("a column of spheres carries the weight above each contact") {
  Setup s;
  s.pairs = "restitution: 0.2, static_friction: 0.3";
  s.geometry = kFloor;
  s.body_forces = kWithGravity;
  Assembly a = assembled(s);
  constexpr int kCount = 10;
  std::vector<Bead> beads(kCount);
  for (int i = 0; i < kCount; ++i) beads[i].position = {0, kRadius * (1 + 2 * i), 0};
  start(a, beads);
  const Energy first = observed(a);
  advance(a, std::llround(1.0 / a.time_step));
  const Energy last = observed(a);
  const double young = effective_young(s.stiffness_factor), weight = bead_mass() * kGravity;
  const auto hertz = [young](double radius, double overlap) { return 4.0 / 3.0 * young * std::sqrt(radius) * std::pow(overlap, 1.5); };
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double y = position(a, i)[1];
    const double force = i == 0 ? hertz(kRadius, kRadius - y) : hertz(0.5 * kRadius, 2 * kRadius - (y - position(a, i - 1)[1]));
    INFO("contact below sphere " << i);
    CHECK(force == Approx((kCount - i) * weight).epsilon(1e-4));
  }
  const dem::Ledger ledger = a.system->ledger();
  CHECK(ledger.bodies[0].force[1] == Approx(-kCount * weight).epsilon(1e-4));
  CHECK(std::abs(ledger.bodies[0].force[0]) < 1e-9 * weight);
  CHECK(ledger.pairs[0].contacts + ledger.pairs[1].contacts == kCount);
  CHECK(last.kinetic < 1e-9 * first.potential);
  CHECK(last.stored() + last.dissipated == Approx(first.stored()).epsilon(1e-6));
  CHECK(last.dissipated == Approx(first.stored() - last.stored()).epsilon(5e-3));
}

TEST_CASE("JKR: a pair that is pulled apart gently holds, one that is torn parts") {
  Setup s;
  s.law = "{kind: jkr}";
  s.pairs = "restitution: 0.5, static_friction: 0.3, surface_energy: 1 J/m^2";
  s.time = "{end_s: 100, step_fraction: 0.05}";
  const auto apart_after = [&s](double speed) {
    Assembly a = assembled(s);
    Bead p, q;
    p.position = {1.999 * kRadius, 0, 0};
    p.velocity = {speed, 0, 0};
    q.velocity = {-speed, 0, 0};
    start(a, {p, q});
    advance(a, std::llround(0.03 / a.time_step));
    return position(a, 0)[0] - position(a, 1)[0] - 2 * kRadius;
  };
  CHECK(apart_after(0.001) < 0);
  CHECK(apart_after(0.5) > kRadius);
}

TEST_CASE("JKR and the simplified JKR: a sphere hangs from a ceiling where its weight and the attraction balance") {
  Setup s;
  s.geometry = kFloor;
  s.body_forces = "{gravity: {kind: gravity, direction: [0, 1, 0]}}";  // away from the plane
  const double weight = bead_mass() * kGravity;
  {
    const double w = 0.3;  // pull-off 3/2 π w R = 3.5 mN, the weight is 1.6 mN
    s.law = "{kind: jkr}";
    s.pairs = fmt::format("restitution: 0.3, static_friction: 0.3, surface_energy: {} J/m^2", w);
    for (const double energy : {w, 0.1 * w}) {
      s.pairs = fmt::format("restitution: 0.3, static_friction: 0.3, surface_energy: {} J/m^2", energy);
      Assembly a = assembled(s);
      Bead b;
      b.position = {0, 0.999 * kRadius, 0};
      start(a, {b});
      advance(a, std::llround(0.2 / a.time_step));
      INFO("surface energy " << energy);
      if (energy == w) {
        CHECK(std::abs(velocity(a, 0)[1]) < 1e-6);
        CHECK(a.system->ledger().bodies[0].force[1] == Approx(weight).epsilon(1e-3));
      } else {
        CHECK(position(a, 0)[1] > 2 * kRadius);
      }
    }
  }
  s.law = "{kind: hertz_mindlin}";
  s.interactions = "{cohesion: {kind: cohesion_sjkr}}";
  const double density = 4e5;
  s.pairs = fmt::format("restitution: 0.3, static_friction: 0.3, cohesion_energy_density: {} J/m^3", density);
  Assembly a = assembled(s);
  Bead b;
  b.position = {0, 0.998 * kRadius, 0};
  start(a, {b});
  advance(a, std::llround(0.3 / a.time_step));
  const double overlap = kRadius - position(a, 0)[1];
  const double hertz = 4.0 / 3.0 * effective_young(s.stiffness_factor) * std::sqrt(kRadius) * std::pow(overlap, 1.5);
  const double attraction = density * std::numbers::pi * overlap * (2 * kRadius - overlap);
  CHECK(overlap > 0);
  CHECK(attraction - hertz == Approx(weight).epsilon(1e-3));
}
