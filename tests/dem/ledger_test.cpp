// The energy book of whole charges: what the walls put in is lost or stored.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "dem/support.hpp"
#include "kernel/dem/ledger.hpp"
#include "millscope/random.hpp"

using namespace dem_test;

namespace {

struct Balance {
  double input = 0, lost = 0, kept = 0;
  double imbalance() const { return (input - lost - kept) / std::abs(input); }
};

Balance balance(const Setup& s, double settle, double span) {
  Assembly a = assembled(s);
  run::insert_beads(a);
  run::begin(a);
  advance(a, -a.first_step + std::llround(settle / a.time_step));
  const Energy first = observed(a);
  advance(a, std::llround(span / a.time_step));
  const Energy last = observed(a);
  return {last.wall_work - first.wall_work, last.dissipated - first.dissipated, last.stored() - first.stored()};
}

/// About 200 beads in a drum of 60 mm with four lifters, 20 mm periodic.
Setup drum() {
  Setup s;
  s.pairs = "restitution: 0.8, static_friction: 0.34";
  s.wall_pairs = "restitution: 0.55, static_friction: 0.30";
  s.fill = "{count: 200, settle_s: 0.05}";
  s.body_forces = kWithGravity;
  s.geometry =
      "{drum: {kind: mill, diameter: 60 mm, length: 20 mm, lifters: 4, lifter_height: 4 mm, lifter_width: 10 mm, material: wall, "
      "motion: {rotation: {speed: 12 rad/s}}}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  s.run = "{partitions: 4}";
  return s;
}

struct LawCase {
  const char* law;
  const char* extra;
  const char* interactions;
};

}  // namespace

TEST_CASE("in a rotating drum the ledger closes within 0.5 % at 20 % of the Rayleigh time") {
  constexpr LawCase kCases[] = {{"{kind: hertz_mindlin}", "", "{}"},
                                {"{kind: hertz_mindlin_deresiewicz}", "", "{}"},
                                {"{kind: linear_spring_dashpot}", ", contact_time: 3e-4 s", "{}"},
                                {"{kind: hertz_mindlin, cap: sum, allow_tension: false}", "", "{}"},
                                {"{kind: hertz_mindlin}", ", rolling_friction: 0.02", "{rolling: {kind: rolling_epsd}}"}};
  for (const LawCase& c : kCases) {
    Setup s = drum();
    s.law = c.law;
    s.pairs += c.extra;
    s.wall_pairs += c.extra;
    s.interactions = c.interactions;
    const Balance b = balance(s, 0.15, 0.4);
    INFO(c.law << ' ' << c.interactions << ": input " << b.input << " J, lost " << b.lost << " J, kept " << b.kept << " J");
    CHECK(b.input > 0.01);
    CHECK(std::abs(b.imbalance()) < 0.005);
  }
}

// A bead in a bed is damped through all its contacts at once. A prediction that runs ahead too far swings from step to step, and makes
// energy: the softest of these beds flew apart.
TEST_CASE("a bed of beads that hardly rebound makes no energy, hard or soft") {
  struct {
    double restitution, stiffness_factor, step_fraction;
  } const cases[] = {{0.5, 1e-3, 0.15}, {0.3, 1e-3, 0.15}, {0.5, 1e-5, 0.15}, {0.3, 1e-5, 0.05}};
  for (const auto& c : cases) {
    Setup s = drum();
    s.pairs = s.wall_pairs = fmt::format("restitution: {}, static_friction: 0.5", c.restitution);
    s.fill = "{count: 301, settle_s: 0.05}";
    s.stiffness_factor = c.stiffness_factor;
    s.time = fmt::format("{{end_s: 100, step_fraction: {}}}", c.step_fraction);
    const Balance b = balance(s, 0.15, 0.4);
    INFO("e = " << c.restitution << ": input " << b.input << " J, lost " << b.lost << " J, kept " << b.kept << " J");
    CHECK(b.input > 0.01);
    CHECK(std::abs(b.imbalance()) < 0.01);
  }
}

TEST_CASE("in a shaken box the ledger closes within 0.5 %, air drag included") {
  Setup s = drum();
  s.geometry =
      "{box: {kind: box, low: [0, 0, 0], high: [30 mm, 60 mm, 30 mm], material: wall, "
      "motion: {translation: {oscillation: {amplitude: [0, 4 mm, 2 mm], frequency: 20 Hz}}}}}";
  s.domain = "{}";
  s.body_forces = "{gravity: {kind: gravity}, air: {kind: air_drag, strength: 20}}";
  const Balance b = balance(s, 0.15, 0.4);
  INFO("input " << b.input << " J, lost " << b.lost << " J, kept " << b.kept << " J");
  CHECK(b.input > 0.01);
  CHECK(std::abs(b.imbalance()) < 0.005);
}

TEST_CASE("a settled charge weighs what it weighs, and the torque on the drum is that of the charge") {
  Setup s = drum();
  Assembly a = assembled(s);
  run::insert_beads(a);
  run::begin(a);
  advance(a, -a.first_step + std::llround(0.3 / a.time_step));
  double force = 0, torque = 0, power = 0, moment = 0;
  const int steps = static_cast<int>(std::llround(0.3 / a.time_step));
  for (int k = 0; k < steps; ++k) {
    a.system->observe = [&](const dem::System& system) {
      const dem::Ledger ledger = system.ledger();
      force += ledger.bodies[0].force[1];
      torque += ledger.bodies[0].torque[2];
      power += ledger.bodies[0].power;
      moment += system.total_mass() * kGravity * system.centre_of_mass()[0];
    };
    a.system->advance();
  }
  const double weight = a.system->total_mass() * kGravity;
  CHECK(force / steps == Approx(-weight).epsilon(0.03));
  CHECK(power / steps == Approx(-12 * torque / steps).epsilon(1e-9));
  CHECK(torque / steps == Approx(-moment / steps).epsilon(0.05));
  CHECK(power / steps > 0);
}

TEST_CASE("an impact's bin is the one between whose edges its energy lies") {
  Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const double energy = std::pow(10, -14 + 18 * random.uniform());
    const int bin = dem::ImpactBins::bin(energy);
    INFO(energy);
    CHECK((bin == 0 || dem::ImpactBins::lower_edge(bin) <= energy));
    CHECK((bin == dem::ImpactBins::kCount - 1 || energy < dem::ImpactBins::lower_edge(bin + 1)));
  }
  for (int b = 0; b < dem::ImpactBins::kCount; ++b) CHECK(dem::ImpactBins::bin(dem::ImpactBins::lower_edge(b)) == b);
  for (const double none : {0.0, -1.0, 1e-320, std::numeric_limits<double>::quiet_NaN()}) CHECK(dem::ImpactBins::bin(none) == 0);
  CHECK(dem::ImpactBins::bin(std::numeric_limits<double>::infinity()) == dem::ImpactBins::kCount - 1);
}
