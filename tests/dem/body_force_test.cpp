// Forces on single beads: drag to the terminal velocity, fluid that moves with a bead, the order of several forces.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

/// Moves `share` of the bead's own mass along with it.
struct Companion {
  double share;
};
/// Pushes each bead with a constant force, N.
struct Push {
  double force;
};

std::int32_t not_uniform(const void*, double, double*) { return 0; }

const BodyForceTable kCompanion{nullptr, nullptr, not_uniform, [](const void* self, BodyForceBatch* b) {
                                  for (std::int64_t k = 0; k < b->count; ++k)
                                    b->added_mass[k] += static_cast<const Companion*>(self)->share * b->mass[k];
                                  b->power_sum = 0;
                                }};
const BodyForceTable kPush{nullptr, nullptr, not_uniform, [](const void* self, BodyForceBatch* b) {
                             const double force = static_cast<const Push*>(self)->force;
                             b->power_sum = 0;
                             for (std::int64_t k = 0; k < b->count; ++k) {
                               b->force[0][k] += force;
                               b->power_sum -= force * b->velocity[0][k];
                             }
                           }};

}  // namespace

TEST_CASE("a falling bead reaches the speed at which drag carries its weight") {
  Setup s;
  s.beads = "{fine: {material: glass, diameter: 0.2 mm}}";
  s.body_forces = "{gravity: {kind: gravity}, air: {kind: air_drag}}";
  s.time = "{end_s: 100, step_s: 1e-5}";
  s.run = "{partitions: 1, allow_unstable: true}";
  Assembly a = assembled(s);
  Bead b;
  b.radius = 1e-4;
  start(a, {b});
  const Energy first = observed(a);
  advance(a, 200000);
  const double d = 2e-4, eta = 1.82e-5, rho = 1.204, weight = bead_mass(1e-4) * kGravity;
  double speed = 0.1;
  for (int k = 0; k < 200; ++k) speed = weight / (3 * std::numbers::pi * eta * d * (1 + 0.15 * std::pow(rho * speed * d / eta, 0.687)));
  CHECK(velocity(a, 0)[1] == Approx(-speed).epsilon(1e-6));
  const Energy last = observed(a);
  CHECK(last.dissipated == Approx(first.stored() - last.stored()).epsilon(1e-4));
}

TEST_CASE("fluid that moves with a bead slows every force, gravity included, whatever the order of the forces") {
  const double share = 0.25, push = 3e-3;
  const Companion companion{share};
  const Push pusher{push};
  for (const bool companion_first : {true, false}) {
    Setup s;
    s.body_forces = kWithGravity;
    Assembly a = assembled(s);
    const dem::BodyForceReference fluid{&kCompanion, &companion, "fluid"}, force{&kPush, &pusher, "push"};
    a.system->body_forces.push_back(companion_first ? fluid : force);
    a.system->body_forces.push_back(companion_first ? force : fluid);
    start(a, {Bead{}, Bead{{0.05, 0, 0}}});
    for (dem::MotionLine& line : a.system->particles.half) line.v[1] = 0;  // half a step of free fall was taken for granted
    advance(a, 1000);
    const double t = 1000 * a.time_step;
    INFO((companion_first ? "added mass first" : "added mass last"));
    CHECK(velocity(a, 0)[1] == Approx(-kGravity * t / (1 + share)).epsilon(1e-9));
    CHECK(velocity(a, 0)[0] == Approx(push / bead_mass() * t / (1 + share)).epsilon(1e-9));
  }
}

TEST_CASE("added mass slows contact forces too") {
  Setup s;
  s.geometry = kFloor;
  s.pairs = "restitution: 1, static_friction: 0";
  s.time = "{end_s: 100, step_fraction: 0.01}";
  Assembly bare = assembled(s), loaded = assembled(s);
  const Companion companion{0.5};
  loaded.system->body_forces.push_back({&kCompanion, &companion, "fluid"});
  Bead b;
  b.position = {0, kRadius * 1.001, 0};
  b.velocity = {0, -0.5, 0};
  const auto duration = [&b](Assembly& a) {
    start(a, {b});
    int steps = 0;
    do {
      a.system->advance();
      steps += a.system->ledger().pairs[1].contacts > 0;
    } while (velocity(a, 0)[1] < 0 || position(a, 0)[1] < kRadius);
    CHECK(velocity(a, 0)[1] == Approx(0.5).epsilon(0.001));
    return steps;
  };
  const double ratio = static_cast<double>(duration(loaded)) / duration(bare);
  CHECK(ratio == Approx(std::pow(1.5, 0.4)).epsilon(0.005));  // Hertz: t ∝ m^{2/5}, of 360 steps
}

TEST_CASE("forces stay with their beads where a long row without neighbours follows a batch of pairs") {
  // The ring of force lines is as long as the beads that carry forces at once. 2048 pairs fill whole batches, so the step pauses and
  // finishes everything up to the first bead that a pair still touches: here thousands of beads further on.
  const Push pusher{3e-3};
  Setup s;
  s.domain = "{low: [-1, -1, -1], high: [1, 1, 1000]}";
  Assembly a = assembled(s);
  a.system->body_forces.push_back({&kPush, &pusher, "push"});
  std::vector<Bead> beads;
  const auto row = [&beads](int count, double gap) {
    for (int k = 0; k < count; ++k) {
      const double z = (beads.empty() ? 0 : beads.back().position[2]) + 2 * kRadius + (gap > 0 && k % 2 ? gap : 3 * kRadius);
      beads.push_back({{0, 0, z}});
    }
  };
  for (int turn = 0; turn < 3; ++turn) {
    row(turn > 0 ? 20000 : 0, 0);
    row(2 * 2048, 0.02 * kRadius);
  }
  start(a, beads);
  advance(a, 20);
  const double expected = pusher.force / bead_mass() * 20 * a.time_step;
  int wrong = 0;
  for (const dem::MotionLine& line : a.system->particles.half) wrong += std::fabs(line.v[0] / expected - 1) > 1e-9 ? 1 : 0;
  CHECK(wrong == 0);
}
