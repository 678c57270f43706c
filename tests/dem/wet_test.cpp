// Wet beads in the kernel: they hang, stick and part where the bridge's force and energy say.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

constexpr double kTension = 0.0728, kRatio = 1e-3;

Setup wet(const char* restitution) {
  Setup s;
  s.interactions = fmt::format("{{bridge: {{kind: capillary_bridge, volume_ratio: {}}}}}", kRatio);
  s.pairs = fmt::format("restitution: {}, static_friction: 0.3, surface_tension: {} N/m", restitution, kTension);
  return s;
}

/// Work that breaks the bridge between two beads, J: the integral of Willett's force to V^{1/3}.
double bridge_energy() {
  const double contact = 2 * std::numbers::pi * kRadius * kTension, end = std::cbrt(kRatio) * kRadius;
  double work = 0;
  constexpr int kSteps = 10000;
  for (int k = 0; k < kSteps; ++k) {
    const double s = (k + 0.5) / kSteps * end / (kRadius * std::sqrt(kRatio));
    work += contact / (1 + 1.05 * s + 2.5 * s * s) * end / kSteps;
  }
  return work;
}

}  // namespace

TEST_CASE("a wet bead hangs from a ceiling until its weight is that of the bridge") {
  const double force = 4 * std::numbers::pi * kRadius * kTension;
  for (const double share : {0.95, 1.05}) {
    Setup s = wet("0.3");
    s.geometry = kFloor;
    s.body_forces = fmt::format("{{gravity: {{kind: gravity, direction: [0, 1, 0], magnitude: {}}}}}", share * force / bead_mass());
    Assembly a = assembled(s);
    Bead b;
    b.position = {0, 0.9999 * kRadius, 0};
    start(a, {b});
    advance(a, std::llround(0.2 / a.time_step));
    INFO("load over force " << share);
    if (share < 1) {
      CHECK(position(a, 0)[1] < kRadius);
      CHECK(a.system->ledger().bodies[0].force[1] == Approx(share * force).epsilon(1e-3));
    } else {
      CHECK(position(a, 0)[1] > 2 * kRadius);
    }
  }
}

TEST_CASE("two wet beads part with what the bridge leaves them, slow ones stick") {
  const double work = bridge_energy(), reduced = 0.5 * bead_mass(), least = std::sqrt(2 * work / reduced);
  INFO("bridge " << work << " J, least speed to part " << least << " m/s");
  for (const double speed : {0.7 * least, 2 * least}) {
    Setup s = wet("1");
    s.time = "{end_s: 100, step_fraction: 0.05}";
    Assembly a = assembled(s);
    Bead p, q;
    p.position = {2.15 * kRadius, 0, 0};
    p.velocity = {-0.5 * speed, 0, 0};
    q.velocity = {0.5 * speed, 0, 0};
    start(a, {p, q});
    const Energy first = observed(a);
    advance(a, std::llround(1.2 * kRadius / least / a.time_step));
    const Energy last = observed(a);
    INFO("speed " << speed << ", kinetic " << first.kinetic << " to " << last.kinetic << " J, booked " << last.dissipated << " J");
    const double gap = position(a, 0)[0] - position(a, 1)[0] - 2 * kRadius;
    CHECK(last.dissipated == Approx(work).epsilon(0.01));
    CHECK(first.stored() == Approx(last.stored() + last.dissipated).epsilon(0.01));
    if (speed < least) {
      CHECK(gap < std::cbrt(kRatio) * kRadius);
    } else {
      CHECK(gap > std::cbrt(kRatio) * kRadius);
      CHECK(last.kinetic == Approx(first.kinetic - work).epsilon(0.01));
    }
  }
}

TEST_CASE("a wet charge with a viscous film in a shaken box keeps its book within 0.5 %") {
  Setup s = wet("0.6");
  s.interactions = "{bridge: {kind: capillary_bridge}, film: {kind: lubrication, viscosity: 0.02}}";
  s.body_forces = kWithGravity;
  const Book book = shaken_box(s);
  INFO("input " << book.input << " J, lost " << book.lost << " J, kept " << book.kept << " J");
  CHECK(book.input > 0.01);
  CHECK(std::fabs(book.input - book.lost - book.kept) < 0.005 * book.input);
}

TEST_CASE("threads and instruction sets change no bit of a wet charge in a pool") {
  Setup s = wet("0.6");
  s.interactions = "{bridge: {kind: capillary_bridge}, film: {kind: lubrication, viscosity: 0.02}}";
  s.fill = "{count: 300, settle_s: 0.01}";
  s.body_forces = "{gravity: {kind: gravity}, pool: {kind: fluid_pool, level: -15 mm, porosity: 0.6}}";
  s.geometry =
      "{drum: {kind: mill, diameter: 80 mm, length: 20 mm, lifters: 6, lifter_height: 4 mm, lifter_width: 10 mm, material: wall, "
      "motion: {rotation: {speed: 14 rad/s}}}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  s.run = "{partitions: 8}";
  const auto hash = [&s](int threads, const std::string& level) {
    Assembly a = assembled(s, {threads, level}, level);
    run::insert_beads(a);
    run::begin(a);
    advance(a, 600);
    return a.system->state_hash();
  };
  const std::uint64_t expected = hash(1, "v2");
  for (const std::string& level : levels()) CHECK(hash(2, level) == expected);
}
