// charge_features on motions that are known.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;

namespace {

/// A mill of 300 mm without beads' size, so that the largest radius of a centre is the shell's.
AnalyzerContext mill(double omega) {
  AnalyzerContext c = study();
  c.omega = omega;
  c.bead_radius = 0;
  c.largest_id = 999;
  return c;
}

constexpr double kOmega = 6.1;
const Vortex kVortex{0.07, -0.05, 0.05, 0.04, 9};

Outcome features_of_vortex(double sense = 1) {
  const Motion motion = vortex_charge(kVortex, 1000);
  const auto times = even_times(80, 0.01);
  return Analyzer("charge_features", mill(sense * kOmega))
      .of(all_beads(sense > 0 ? motion : mirrored(motion), 1000, times, even_weights(80, 0.01), sense * kOmega));
}

const Davis kDavis{kOmega};

Outcome features_of_davis(double sense = 1) {
  const Motion motion = davis_charge(kDavis, 1000, 0.06, 0.148);
  const auto times = even_times(300, 0.005);
  return Analyzer("charge_features", mill(sense * kOmega))
      .of(all_beads(sense > 0 ? motion : mirrored(motion), 1000, times, even_weights(300, 0.005), sense * kOmega));
}

}  // namespace

TEST_CASE("the centre of a vortex is found with its rotation") {
  const Outcome o = features_of_vortex();
  CHECK_THAT(number(o, "centre_of_circulation_x"), WithinAbs(kVortex.x, 2e-4));
  CHECK_THAT(number(o, "centre_of_circulation_y"), WithinAbs(kVortex.y, 2e-4));
  // u = −ω a/b (y − y₀), v = ω b/a (x − x₀)
  CHECK_THAT(number(o, "rotation_at_centre"), WithinAbs(0.5 * kVortex.rate * (0.05 / 0.04 + 0.04 / 0.05), 0.05));
  CHECK_THAT(number(o, "centre_of_mass_x"), WithinAbs(kVortex.x, 5e-4));
  CHECK_THAT(number(o, "torque_arm"), WithinAbs(kVortex.x, 5e-4));
  CHECK_THAT(number(o, "centre_of_mass_angle"), WithinAbs(std::atan2(0.07, 0.05) / kRadians, 0.3));
  CHECK_THAT(number(o, "en_masse_share") + number(o, "cascading_share") + number(o, "cataracting_share") + number(o, "eye_share"),
             WithinAbs(1, 1e-12));
}

TEST_CASE("the equilibrium surface lies where the flow round the axis changes its sign") {
  const Outcome o = features_of_vortex();
  const auto& radius = values(o, "equilibrium_radius");
  const auto& edges = values(o, "equilibrium_angle_edges_deg");
  int seen = 0;
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double angle = 0.5 * (edges[i] + edges[i + 1]) * kRadians, dx = std::sin(angle), dy = -std::cos(angle);
    // r · (u_y x − u_x y) = 0 along the ray: (b/a) x (x − x₀) + (a/b) y (y − y₀) = 0
    const double expected = (0.8 * dx * kVortex.x + 1.25 * dy * kVortex.y) / (0.8 * dx * dx + 1.25 * dy * dy);
    if (std::isnan(radius[i]) || std::fabs(angle - 0.95) > 0.3) continue;
    CHECK_THAT(radius[i], WithinAbs(expected, 0.004));
    ++seen;
  }
  CHECK(seen >= 2);
}

TEST_CASE("shoulder, toe and flights of Davis's charge lie where his theory puts them") {
  const Outcome o = features_of_davis();
  const double shoulder = kDavis.departure(0.148) / kRadians, toe = kDavis.landing(0.148) / kRadians;
  CHECK(std::isfinite(number(o, "centre_of_circulation_x")));
  // The inward velocity begins with the square of the angle flown, so the line through it meets zero some degrees later.
  CHECK(number(o, "departure_shoulder") > shoulder);
  CHECK(number(o, "departure_shoulder") < shoulder + 12);
  // Half of what comes back into the zone beyond 0.85 radii lands at the angle that splits the ring's area, between 0.1275 and 0.148 m.
  const double middle = std::sqrt(0.5 * (0.1275 * 0.1275 + 0.148 * 0.148));
  CHECK_THAT(number(o, "bulk_toe"), WithinAbs(kDavis.landing(middle) / kRadians, 5));
  CHECK(number(o, "farthest_toe") > toe - 5);
  CHECK(number(o, "impact_toe") > toe);
  CHECK(number(o, "impact_toe") < kDavis.landing(0.06) / kRadians);
  CHECK(number(o, "cataracting_share") > 0.2);
  double highest = 0;
  for (double t = 0; t < kDavis.flight_time(0.148); t += 1e-3) highest = std::max(highest, kDavis.flight(0.148, t).position[1]);
  CHECK_THAT(number(o, "head_height"), WithinAbs(highest, 0.003));
  CHECK(number(o, "flights_landed") > 500);
}

TEST_CASE("the shoulder is where the mean flow begins to turn inwards, also for inner streamlines that turn earlier") {
  // A vortex inside, and next to the shell a stream that turns with it; what flies inwards grows with the angle beyond the departure.
  constexpr double kShoulder = 115 * kRadians, kEarlier = 3, kSlope = 0.6, kToe = -30 * kRadians;
  const Motion inside = vortex_charge({0.05, -0.04, 0.035, 0.035, 9}, 500);
  const Motion motion = [&](std::int64_t id, double t) {
    if (id < 500) return inside(id, t);
    const double share = static_cast<double>(id - 500) / 2500, r = 0.085 + 0.063 * std::fmod(share * 40.62, 1.0);
    const double a = (-50 + 200 * share) * kRadians, speed = kOmega * 0.15;
    double outward = -speed * kSlope * std::max(0.0, a - kShoulder + kEarlier * (1 - r / 0.15));
    if (a < kToe) outward = 0.3 * speed;
    const double around = kOmega * r, s = std::sin(a), c = std::cos(a);
    return Sample{{r * s, -r * c, 0}, {outward * s + around * c, -outward * c + around * s, 0}};
  };
  AnalyzerContext context = mill(kOmega);
  context.largest_id = 2999;
  const Outcome o = Analyzer("charge_features", context).of(all_beads(motion, 3000, even_times(20, 0.01), even_weights(20, 0.01), kOmega));
  CHECK_THAT(number(o, "departure_shoulder"), WithinAbs(115, 1));
  CHECK_THAT(number(o, "bulk_toe"), WithinAbs(-40, 1));
  CHECK_THAT(number(o, "farthest_toe"), WithinAbs(-48, 2.5));
}

TEST_CASE("features of a mill that turns the other way are the mirror image") {
  for (const auto& [a, b] :
       {std::pair{features_of_vortex(1), features_of_vortex(-1)}, std::pair{features_of_davis(1), features_of_davis(-1)}}) {
    for (const auto& [name, found] : a) {
      if (found.values.size() > 1) continue;
      const double sign = name == "centre_of_circulation_x" || name == "centre_of_mass_x" ? -1 : 1;
      INFO(name);
      const double other = number(b, name);
      CHECK(std::isnan(found.values[0]) == std::isnan(other));
      if (!std::isnan(other)) CHECK_THAT(found.values[0], WithinAbs(sign * other, 1e-6 * std::max(1.0, std::fabs(other))));
    }
  }
}

TEST_CASE("a charge that turns rigidly has neither shoulder nor toe") {
  const auto times = even_times(50, 0.01);
  const Outcome o = Analyzer("charge_features", mill(kOmega))
                        .of(all_beads(turning_disc(1000, 0.148, kOmega), 1000, times, even_weights(50, 0.01), kOmega));
  CHECK(std::isnan(number(o, "departure_shoulder")));
  CHECK(std::isnan(number(o, "bulk_toe")));
  CHECK(number(o, "cascading_share") == 0);
  CHECK(number(o, "en_masse_share") > 0.97);
}

TEST_CASE("which results there are does not depend on the data") {
  for (const char* name : {"charge_features", "circulation", "free_flight", "ergodicity"}) {
    INFO(name);
    const Analyzer analyzer(name, mill(kOmega));
    const Outcome empty = analyzer.finish(analyzer.zero());
    const Outcome full =
        analyzer.of(all_beads(davis_charge(kDavis, 50, 0.06, 0.148), 50, even_times(200, 0.01), even_weights(200, 0.01), kOmega));
    REQUIRE(empty.size() == full.size());
    for (const auto& [result, found] : full) {
      INFO(result);
      REQUIRE(empty.count(result) == 1);
      CHECK(empty.at(result).shape == found.shape);
    }
  }
}

TEST_CASE("features add up over blocks, and beads may come together or one by one") {
  const Motion motion = davis_charge(kDavis, 60, 0.06, 0.148);
  const auto times = even_times(400, 0.005);
  const Analyzer analyzer("charge_features", mill(kOmega));
  const Frames together = all_beads(motion, 60, times, even_weights(400, 0.005), kOmega);
  const Outcome whole = analyzer.of(together);
  Sums alone = analyzer.zero();
  for (std::int64_t bead = 0; bead < 60; ++bead) {
    const Frames one = one_bead(motion, bead, times, even_weights(400, 0.005), kOmega);
    analyzer.add(one.block(), alone);
  }
  CHECK(difference(whole, analyzer.finish(alone)) < 1e-9);

  // Cut in time only flights across the cut change, so maps of time and velocity stay.
  Sums parts = analyzer.zero();
  analyzer.add(together.block(0, 150), parts);
  analyzer.add(together.block(150, 400), parts);
  const Outcome cut = analyzer.finish(parts);
  for (const char* name : {"centre_of_circulation_x", "departure_shoulder", "bulk_toe", "head_height", "centre_of_mass_y"}) {
    INFO(name);
    CHECK_THAT(number(cut, name), WithinAbs(number(whole, name), 1e-9 * 360));
  }
}

TEST_CASE("lifter pockets and end bands are told where their size is known") {
  const auto times = even_times(50, 0.01);
  const Frames frames = all_beads(turning_disc(1000, 0.15, kOmega), 1000, times, even_weights(50, 0.01), kOmega);
  const Outcome o = Analyzer("charge_features", mill(kOmega), "lifter_height=0.01 end_band=0.027").of(frames);
  CHECK_THAT(number(o, "pocket_share"), WithinAbs(1 - 0.14 * 0.14 / (0.15 * 0.15), 0.002));
  CHECK_THAT(number(o, "end_band_share"), WithinAbs(0.2, 0.002));
  CHECK(Analyzer("charge_features", mill(kOmega)).of(frames).count("pocket_share") == 0);
}

TEST_CASE("what features cannot do without is refused with the remedy") {
  AnalyzerContext c = mill(kOmega);
  c.mill_radius = 0;
  CHECK_THROWS_WITH(Analyzer("charge_features", c), Catch::Contains("radius"));
  c = mill(0);
  CHECK_THROWS_WITH(Analyzer("charge_features", c), Catch::Contains("speed"));
  c = mill(kOmega);
  c.gravity = 0;
  CHECK_THROWS_WITH(Analyzer("free_flight", c), Catch::Contains("gravity"));
  c = mill(kOmega);
  c.is_periodic = 1;
  CHECK_THROWS_WITH(Analyzer("charge_features", c, "end_band=0.01"), Catch::Contains("periodic"));
}

TEST_CASE("without gravity flights are left out, and the rest stays") {
  AnalyzerContext c = mill(kOmega);
  c.gravity = 0;
  const Motion motion = davis_charge(kDavis, 200, 0.06, 0.148);
  const Outcome o = Analyzer("charge_features", c).of(all_beads(motion, 200, even_times(200, 0.005), even_weights(200, 0.005), kOmega));
  CHECK(std::isfinite(number(o, "departure_shoulder")));
  for (const char* name : {"cataracting_share", "flight_fraction", "impact_toe"}) CHECK(o.count(name) == 0);
}
