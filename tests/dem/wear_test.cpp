// What beads take away from walls, against the laws in closed form.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <numeric>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

constexpr double kCoefficient = 1e-3, kHardness = 2e9, kCuttingShare = 0.4;

/// A floor that beads wear, counted from the start or from `from`, s.
Setup worn_floor(const char* laws, double from = 0) {
  Setup s;
  s.wear = laws;
  s.pairs = "restitution: 0.3, static_friction: 0.2";
  const std::string names = laws;
  if (names.find("archard") != std::string::npos) s.pairs += fmt::format(", wear_coefficient: {}", kCoefficient);
  if (names.find("finnie") != std::string::npos) s.pairs += fmt::format(", cutting_share: {}", kCuttingShare);
  s.pairs += fmt::format(", hardness: {} Pa", kHardness);
  s.geometry = "{floor: {kind: box, low: [-1, 0, -1], high: [1, 1, 1], open: \"+y -x +x -z +z\", material: wall}}";
  s.time = fmt::format("{{end_s: 100, step_fraction: 0.2, analyze_from_s: {}}}", from);
  return s;
}

/// Of the one pair of bead and wall, m³.
double told(const Assembly& a, std::size_t law = 0) {
  const dem::Ledger ledger = a.system->ledger();
  for (std::size_t p = 0; p < ledger.pairs.size(); ++p) {
    if (a.system->physics()[p].name == "glass~wall (wall)") return ledger.pairs[p].worn.at(law);
  }
  throw std::logic_error("no such pair");
}

double on_triangles(const Assembly& a) {
  const std::vector<double> worn = a.system->worn_volume(0);
  return std::accumulate(worn.begin(), worn.end(), 0.0);
}

/// What one bead takes away that strikes the floor at `angle` with `speed`, m³.
double struck(double speed, double angle, const char* interactions = "{}") {
  Setup s = worn_floor("{cut: {kind: finnie}}");
  s.interactions = interactions;
  Assembly a = assembled(s);
  Bead b;
  b.position = {0, kRadius + 1e-4, 0};
  b.velocity = {speed * std::cos(angle), -speed * std::sin(angle), 0};
  start(a, {b});
  advance(a, std::llround(2e-3 / a.time_step));
  return told(a);
}

}  // namespace

TEST_CASE("a bead that slides until it rolls takes k m v0^2/(7 mu H) from the floor, by Archard") {
  for (const char* law : {"{kind: hertz_mindlin}", "{kind: hertz_mindlin, cap: sum}", "{kind: hertz_mindlin_deresiewicz}"}) {
    INFO(law);
    Setup s = worn_floor("{rub: {kind: archard}}");
    s.law = law;
    s.body_forces = kWithGravity;
    Assembly a = assembled(s);
    const double v0 = 0.5, mu = 0.2;
    Bead b;
    b.position = {0, kRadius - resting_overlap(s.stiffness_factor), 0};
    b.velocity = {v0, 0, 0};
    start(a, {b});
    advance(a, std::llround(2 * 2 * v0 / (7 * mu * kGravity) / a.time_step));  // twice as long as it slides
    CHECK(told(a) == Approx(kCoefficient * bead_mass() * v0 * v0 / (7 * mu * kHardness)).epsilon(0.01));
    CHECK(on_triangles(a) == Approx(told(a)).epsilon(1e-12));
  }
}

TEST_CASE("a bead that strikes and sticks hardly slides") {
  Setup s = worn_floor("{rub: {kind: archard}}");
  s.pairs = fmt::format("restitution: 0.6, static_friction: 0.9, wear_coefficient: {}, hardness: {} Pa", kCoefficient, kHardness);
  Assembly a = assembled(s);
  Bead b;
  const double down = 2, along = 0.3;
  b.position = {0, kRadius + 1e-4, 0};
  b.velocity = {along, -down, 0};
  start(a, {b});
  advance(a, std::llround(2e-3 / a.time_step));
  CHECK(velocity(a, 0)[1] > 1);
  CHECK(told(a) < 0.15 * kCoefficient / kHardness * bead_mass() * 1.6 * down * along);  // were all of its motion sliding
}

TEST_CASE("an attraction that is not in the law's own force does not lessen what presses where friction counts it not") {
  const auto slid = [](const char* interactions, const char* more) {
    Setup s = worn_floor("{rub: {kind: archard}}");
    s.pairs += more;
    s.interactions = interactions;
    s.body_forces = kWithGravity;
    Assembly a = assembled(s);
    Bead b;
    b.position = {0, kRadius, 0};
    b.velocity = {0.5, 0, 0};
    start(a, {b});
    advance(a, std::llround(0.02 / a.time_step));
    // by how much friction has slowed it tells the pressing force: k F s/H, with F from the loss of speed
    const double slide = 0.5 - velocity(a, 0)[0];
    return told(a) / slide;
  };
  const double dry = slid("{}", "");
  CHECK(slid("{glue: {kind: cohesion_sjkr}}", ", cohesion_energy_density: 2e4 J/m^3") == Approx(dry).epsilon(0.05));
}

TEST_CASE("what is worn before the analysis begins is not counted") {
  Setup s = worn_floor("{rub: {kind: archard}}", 1);
  s.body_forces = kWithGravity;
  Assembly a = assembled(s);
  Bead b;
  b.position = {0, kRadius, 0};
  b.velocity = {0.5, 0, 0};
  start(a, {b});
  advance(a, std::llround(0.1 / a.time_step));
  CHECK(told(a) == 0);
  CHECK(on_triangles(a) == 0);
}

TEST_CASE("a bead at rest takes nothing from the floor") {
  Setup s = worn_floor("{rub: {kind: archard}, cut: {kind: finnie}}");
  s.body_forces = kWithGravity;
  Assembly a = assembled(s);
  Bead b;
  b.position = {0, kRadius - resting_overlap(s.stiffness_factor), 0};
  start(a, {b});
  advance(a, 2000);
  CHECK(told(a) < 1e-9 * kCoefficient * bead_mass() / kHardness);  // of a slide at 1 m/s
}

TEST_CASE("a bead that strikes at a slant takes what Finnie's law says, most of all at 17 degrees and nothing straight on") {
  const double speed = 2, whole = kCuttingShare * bead_mass() * speed * speed / (4 * kHardness);
  for (const double angle : {0.1, 0.25, 0.3, 0.5, 1.0, 1.4}) {
    INFO(angle);
    const double s = std::sin(angle), c = std::cos(angle);
    const double expected = std::tan(angle) <= 1.0 / 3 ? whole * (2 * s * c - 3 * s * s) : whole * c * c / 3;
    CHECK(struck(speed, angle) == Approx(expected).epsilon(0.01));
  }
  CHECK(struck(speed, 0.29) > struck(speed, 0.15));
  CHECK(struck(speed, 0.29) > struck(speed, 0.6));
  CHECK(struck(speed, std::acos(-1.0) / 2) < 1e-6 * whole);
}

TEST_CASE("a film round the beads, within whose reach a contact begins before it touches, changes no impact") {
  const double dry = struck(2, 0.5);
  CHECK(struck(2, 0.5, "{film: {kind: lubrication, viscosity: 1e-9 Pa s, cut: 0.01, range: 0.2}}") == Approx(dry).epsilon(0.01));
}

TEST_CASE("wear changes no motion, and a checkpoint keeps it") {
  Setup s = worn_floor("{rub: {kind: archard}, cut: {kind: finnie}}");
  s.body_forces = kWithGravity;
  Bead b;
  b.position = {0, kRadius + 1e-3, 0};
  b.velocity = {0.5, 0, 0.1};
  const auto begun = [&b](const Setup& setup) {
    Assembly a = assembled(setup);
    start(a, {b});
    advance(a, 3000);
    return a;
  };
  Assembly with = begun(s);
  Setup plain = s;
  plain.wear = "{}", plain.pairs = "restitution: 0.3, static_friction: 0.2";
  Assembly without = begun(plain);
  CHECK(with.system->state_hash() == without.system->state_hash());
  Assembly again = assembled(s);
  start(again, {b});
  restore(again, saved(with));
  CHECK(on_triangles(again) == on_triangles(with));
  CHECK(told(again, 0) == told(with, 0));
  advance(again, 500);
  advance(with, 500);
  CHECK(told(again, 0) == told(with, 0));
  CHECK(told(again, 1) == told(with, 1));
  CHECK(on_triangles(again) == Approx(told(again, 0) + told(again, 1)).epsilon(1e-12));
  again.system->forget_wear();  // as where a resumed run analyses from later
  CHECK(on_triangles(again) == 0);
  CHECK(told(again, 0) + told(again, 1) == 0);
}
