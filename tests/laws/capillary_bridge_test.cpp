// Bridges of liquid: Willett's formula, formation, breakage, energy.
#include <catch2/catch.hpp>

#include "laws/one_pair.hpp"
#include "laws/two_bodies.hpp"

using namespace laws_test;

namespace {

constexpr double kPi = 3.14159265358979323846, kTension = 0.0728;

PairContext wall_pair() {
  PairContext pair = bead_pair();
  pair.with_wall = 1;
  pair.smallest_radius = pair.largest_radius = 5e-3;
  return pair;
}

/// One pair of glass beads (or a bead and a wall) whose gap is set by hand; history is kept.
struct Bridge {
  std::string text = "surface_tension=0.0728";
  PairContext context = bead_pair();
  OnePair pair;

  double at(double gap) {
    pair.overlap[0] = -gap;
    pair.added_force[0] = pair.added_cap[0] = 0.0;
    pair.evaluate("capillary_bridge", text, context);
    return pair.added_force[0];
  }
};

double rupture(double ratio, double angle, double radius) { return (1 + 0.5 * angle) * std::cbrt(ratio) * radius; }

}  // namespace

TEST_CASE("water holds glass beads of 3, 5 and 10 mm with 2.0, 0.7 and 0.18 of their weight") {
  for (const auto& [diameter, expected] : {std::pair{3e-3, 2.0}, {5e-3, 0.71}, {10e-3, 0.18}}) {
    const double radius = 0.5 * diameter, weight = bead(radius).mass * 9.81;
    Bridge b;
    b.pair.radius_i[0] = b.pair.radius_j[0] = radius;
    b.pair.radius[0] = 0.5 * radius;
    const double force = b.at(-1e-6);
    CHECK(force == Approx(-2 * kPi * radius * kTension));
    CHECK(-force / weight == Approx(expected).epsilon(0.02));
    CHECK(b.at(-5e-6) == force);  // the same at every overlap
    CHECK(b.pair.added_cap[0] == 0.0);
  }
}

TEST_CASE("the force falls with the gap as Willett's closed form says") {
  const double radius = 5e-3, ratio = 2e-3, angle = 0.6, volume = ratio * radius * radius * radius;
  Bridge b;
  b.text = "surface_tension=0.0728 contact_angle=0.6 volume_ratio=0.002 friction=net";
  b.at(-1e-6);
  for (const double gap : {0.0, 1e-5, 1e-4, 4e-4, 0.8e-3}) {
    const double s = gap * std::sqrt(radius / volume);
    CHECK(b.at(gap) == Approx(-2 * kPi * radius * kTension * std::cos(angle) / (1 + 1.05 * s + 2.5 * s * s)));
    CHECK(b.pair.added_cap[0] == b.pair.added_force[0]);
  }
  Bridge unlike;
  unlike.pair.radius_i[0] = 2e-3, unlike.pair.radius_j[0] = 6e-3, unlike.pair.radius[0] = 1.5e-3;
  CHECK(unlike.at(-1e-6) == Approx(-2 * kPi * 3e-3 * kTension));  // 2 R* = 3 mm
  Bridge wall;
  wall.context = wall_pair();
  wall.pair.radius[0] = 5e-3, wall.pair.radius_j[0] = 0.0;
  CHECK(wall.at(-1e-6) == Approx(-4 * kPi * 5e-3 * kTension));
  const double stretch = 1e-4 * std::sqrt(10e-3 / (1e-3 * radius * radius * radius));
  CHECK(wall.at(1e-4) == Approx(-4 * kPi * 5e-3 * kTension / (1 + 1.05 * stretch + 2.5 * stretch * stretch)));
}

TEST_CASE("a bridge forms on touch only and lives until it breaks") {
  for (const bool with_wall : {false, true}) {
    Bridge b;
    b.text += " contact_angle=0.4";
    if (with_wall) b.context = wall_pair(), b.pair.radius[0] = 5e-3, b.pair.radius_j[0] = 0.0;
    const double end = rupture(1e-3, 0.4, 5e-3);
    const Descriptor& d = plugin("capillary_bridge");
    const ValueSet values = values_of(d, b.text);
    const Held<InteractionTable> held(*static_cast<const InteractionTable*>(d.table), values.view(), b.context);
    CHECK(held.table().reach(held.get(), b.pair.radius[0]) == Approx(end));

    CHECK(b.at(0.5 * end) == 0.0);  // coming closer: no bridge yet
    CHECK(b.at(1e-9) == 0.0);
    CHECK(b.at(-1e-7) < 0.0);
    CHECK(b.at(0.5 * end) < 0.0);
    CHECK(b.at(0.999 * end) < 0.0);
    CHECK(b.at(1.001 * end) == 0.0);
    CHECK(b.at(0.5 * end) == 0.0);  // broken
  }
  Bridge dry;
  dry.text = "surface_tension=0";
  for (const double gap : {-1e-5, 1e-5}) CHECK(dry.at(gap) == 0.0);
  CHECK(dry.pair.batch.elastic_sum == 0.0);
  const Descriptor& d = plugin("capillary_bridge");
  const ValueSet values = values_of(d, dry.text);
  const Held<InteractionTable> held(*static_cast<const InteractionTable*>(d.table), values.view(), bead_pair());
  CHECK(held.table().reach(held.get(), 2.5e-3) == 0.0);
}

TEST_CASE("the bridge's energy is the work to break it, and that is what a touch loses") {
  const std::pair<const char*, double> cases[] = {{"surface_tension=0.0728", 0},
                                                  {"surface_tension=0.0728 contact_angle=1 volume_ratio=0.05", 1},
                                                  {"surface_tension=0.0728 volume_ratio=1e-8", 0}};
  for (const auto& [text, angle] : cases) {
    INFO(text);
    Bridge b;
    b.text = text;
    b.at(-1e-15);
    const double lost = b.pair.batch.power_sum[0] * b.pair.batch.time_step, bound = -b.pair.batch.elastic_sum;
    const Descriptor& d = plugin("capillary_bridge");
    const ValueSet values = values_of(d, text);
    const Held<InteractionTable> held(*static_cast<const InteractionTable*>(d.table), values.view(), bead_pair());
    const double end = held.table().reach(held.get(), 2.5e-3);
    double work = 0;
    constexpr int kSteps = 4000;
    for (int k = 0; k < kSteps; ++k) {
      const double half = -0.5 * b.at((k + 0.5) / kSteps * end) * end / kSteps;
      CHECK(-b.pair.batch.elastic_sum == Approx(bound - (work + half)).margin(1e-5 * bound));  // what is left, on the way
      work += 2 * half;
      CHECK(b.pair.batch.power_sum[0] == 0.0);  // booked once
    }
    CHECK(bound == Approx(work).epsilon(1e-5));
    CHECK(lost == Approx(bound).epsilon(1e-6));
    b.at(end);
    CHECK(b.pair.batch.elastic_sum == Approx(0.0).margin(1e-12 * bound));
    b.at(-1e-6);  // pressed together: the constant force gives its work
    CHECK(-b.pair.batch.elastic_sum == Approx(bound + 2 * kPi * 5e-3 * kTension * std::cos(angle) * 1e-6));
  }
}

TEST_CASE("what is left of a bridge's energy is the closed form, with the standard library's arctangent") {
  const double radius = 5e-3, root = std::sqrt(10 - 1.05 * 1.05), strength = 2 * kPi * radius * kTension;
  for (const char* ratio_text : {"1e-9", "1e-3", "0.1"}) {
    const double ratio = std::atof(ratio_text);
    Bridge b;
    b.text = std::string("surface_tension=0.0728 volume_ratio=") + ratio_text;
    INFO(b.text);
    const double length = std::sqrt(ratio) * radius, end = rupture(ratio, 0, radius) / length;  // of ŝ = 1; ŝ where it breaks
    // z is tan π/8, where the arctangent changes its way, at this ŝ.
    const double z = std::sqrt(2.0) - 1, turn = (root * end - z * (2 + 1.05 * end)) / (root + z * (1.05 + 5 * end));
    b.at(-1e-15);
    const double whole = -b.pair.batch.elastic_sum;
    for (const double stretch : {1e-6, 0.1 * end, turn - 1e-7, turn + 1e-7, 0.7 * end, 0.999 * end}) {
      const double angle = std::atan(root * (end - stretch) / (2 + 1.05 * (stretch + end) + 5 * stretch * end));
      b.at(stretch * length);
      CHECK(-b.pair.batch.elastic_sum == Approx(strength * length * 2 / root * angle).margin(1e-12 * whole));
    }
  }
}
