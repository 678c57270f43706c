// bed_profile where the flow is known: a tilted segment whose velocity along its surface depends on depth alone.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double kAngle = 28 * kRadians, kSurface = -0.03;  // of the free surface; its place on the normal, m

AnalyzerContext mill(double omega) {
  AnalyzerContext c = study();
  c.omega = omega;
  return c;
}

/// Along the surface at position p of the normal: with the shell below, down the slope above.
double flow(double p) { return 0.2 - 20 * std::pow(p + 0.14, 2) * (p > -0.14 ? 1 : 0); }

/// One bead per spot of a lattice over the segment, seen once.
Frames segment(double omega, double shell) {
  const double sense = omega > 0 ? 1 : -1;
  const double g[2] = {sense * std::sin(kAngle), -std::cos(kAngle)}, t[2] = {-sense * g[1], sense * g[0]};
  Frames frames;
  constexpr int kSpots = 241;
  std::int64_t id = 0;
  for (int i = 0; i < kSpots; ++i) {
    for (int j = 0; j < kSpots; ++j) {
      const double p = (2.0 * i / (kSpots - 1) - 1) * shell, s = (2.0 * j / (kSpots - 1) - 1) * shell;
      if (p > kSurface || std::hypot(p, s) > shell) continue;
      const double v = flow(p);
      frames.add_sample(id++, Sample{{-p * g[0] + s * t[0], -p * g[1] + s * t[1], 0.1}, {v * t[0], v * t[1], 0}}, 0.01);
    }
  }
  frames.end_frame(0, omega);
  return frames;
}

}  // namespace

TEST_CASE("the profile of a tilted bed is its flow by depth, whichever way the mill turns") {
  for (const double omega : {5.0, -5.0}) {
    const AnalyzerContext context = mill(omega);
    const double shell = context.mill_radius;
    const Outcome o = Analyzer("bed_profile", context).of(segment(omega, shell));
    CHECK_THAT(number(o, "surface_angle"), WithinAbs(28, 0.2));
    CHECK_THAT(number(o, "still_position"), WithinAbs(-0.14 + std::sqrt(0.2 / 20), 0.002));
    const auto position = values(o, "position"), velocity = values(o, "velocity");
    REQUIRE(position.size() == 51);
    CHECK_THAT(position.front(), WithinAbs(-shell, 1e-12));
    CHECK_THAT(position.back(), WithinAbs(shell, 1e-12));
    int looked = 0;
    for (std::size_t k = 1; k < position.size(); ++k) {
      if (position[k] > kSurface + 0.006) {
        CHECK(std::isnan(velocity[k]));
      } else if (position[k] < kSurface - 0.006) {
        CHECK_THAT(velocity[k], WithinAbs(flow(position[k]), 0.004));
        ++looked;
      }
    }
    CHECK(looked >= 15);
  }
}

TEST_CASE("a profile that is asked for along part of the axis sees the beads there alone") {
  const Frames frames = segment(5, mill(5).mill_radius);  // all at z = 0.1 m
  const auto seen = [&](const char* to) {
    const Outcome o = Analyzer("bed_profile", mill(5), std::string("z_from=0 z_to=") + to).of(frames);
    double sum = 0;
    for (const double share : values(o, "time_share")) sum += std::isfinite(share) ? share : 0;
    return sum;
  };
  CHECK(seen("0.2") > 0);
  CHECK(seen("0.05") == 0);
}
