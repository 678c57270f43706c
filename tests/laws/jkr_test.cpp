// Adhesion: pull-off force, gap at parting, jump into contact, agreement with the equations of Johnson, Kendall & Roberts.
#include <catch2/catch.hpp>

#include "laws/two_bodies.hpp"

using namespace laws_test;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 2.5e-3;

/// Normal force at a sequence of overlaps, at rest.
std::vector<double> pull(const Law& law, const std::vector<double>& overlaps) {
  Contacts c(1);
  c.own_friction = true;
  c.radius[0] = kRadius;
  c.mass[0] = bead_pair().largest_mass;
  Contacts::put(c.normal, 0, {1, 0, 0});
  std::vector<double> force;
  for (const double overlap : overlaps) {
    c.overlap[0] = overlap;
    c.step(law, 1e-6);
    force.push_back(c.normal_force[0]);
  }
  return force;
}

}  // namespace

TEST_CASE("the force of JKR solves its equations over eight decades of adhesion") {
  const double young = bead_pair().effective_young;
  for (const double w : {1e-6, 1e-3, 1.0, 100.0}) {
    const Law law = make_law("jkr", "restitution=1 static_friction=0.3 surface_energy=" + std::to_string(w));
    for (const double contact : {5e-5, 2e-4, 5e-4}) {
      const double overlap = contact * contact / kRadius - std::sqrt(2 * kPi * w * contact / young);
      const double expected =
          4.0 / 3.0 * young * contact * contact * contact / kRadius - std::sqrt(8 * kPi * w * young * contact * contact * contact);
      if (overlap < 0) continue;
      INFO("w = " << w << ", a = " << contact);
      CHECK(pull(law, {overlap})[0] == Approx(expected).epsilon(1e-9));
    }
  }
}

TEST_CASE("beads pull with at most 3/2 pi w R* and part at the gap that reach gives") {
  const double w = 0.5;
  const Law law = make_law("jkr", "restitution=1 static_friction=0.3 surface_energy=0.5");
  const double gap = law.table().reach(law.get(), kRadius);
  CHECK(gap > 0.0);
  std::vector<double> overlaps;
  for (int k = 0; k <= 20000; ++k) overlaps.push_back(1e-5 - (1e-5 + gap * 0.999999) * k / 20000.0);
  const std::vector<double> force = pull(law, overlaps);
  CHECK(*std::min_element(force.begin(), force.end()) == Approx(-1.5 * kPi * w * kRadius).epsilon(1e-6));
  CHECK(force.back() == Approx(-5.0 / 9.0 * 1.5 * kPi * w * kRadius).epsilon(0.01));
  CHECK(pull(law, {1e-6, -1.001 * gap, -0.9 * gap}) == std::vector<double>{pull(law, {1e-6})[0], 0.0, 0.0});
  CHECK(pull(law, {-0.5 * gap})[0] == 0.0);
}

TEST_CASE("slow beads stick, fast ones rebound") {
  const Law law = make_law("jkr", "restitution=0.9 static_friction=0.3 surface_energy=0.5");
  Collision slow = head_on(law, 0.002), fast = head_on(law, 1.0);
  slow.run(1e-6, 0.05);
  fast.run(1e-6, 0.05);
  CHECK(slow.i().position[0] - slow.j().position[0] < 0.01 + law.table().reach(law.get(), kRadius));
  CHECK(fast.i().half_velocity[0] == Approx(0.45).epsilon(0.005));  // e = 0.9: adhesion takes 2e-5 of the energy
}

TEST_CASE("adhesion carries a load of its own in the cap of friction") {
  Contacts c(1);
  const Law law = make_law("jkr", "restitution=1 static_friction=0.3 surface_energy=0.5");
  c.own_friction = true;
  c.radius[0] = kRadius;
  c.mass[0] = bead_pair().largest_mass;
  c.overlap[0] = 1e-9;
  Contacts::put(c.normal, 0, {1, 0, 0});
  Contacts::put(c.velocity, 0, {0, 1, 0});
  for (int k = 0; k < 50; ++k) c.step(law, 1e-4);
  CHECK(-c.force[1][0] == Approx(0.3 * (c.normal_force[0] + 3.0 * kPi * 0.5 * kRadius)).epsilon(1e-9));
}
