// silhouette of a few beads whose shadows are known.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

AnalyzerContext mill(double omega) {
  AnalyzerContext c = study();
  c.omega = omega;
  c.has |= kHasAllBeads;
  return c;
}

/// Frames with all beads in each: places (radii of the shell) by frame; each frame stands for its weight.
struct Seen {
  std::vector<std::array<double, 3>> beads;
  double weight;
};

Frames frames_of(const std::vector<Seen>& seen, double omega) {
  const double shell = mill(omega).mill_radius;
  Frames frames;
  double t = 0;
  for (const Seen& frame : seen) {
    std::int64_t id = 0;
    for (const auto& b : frame.beads) frames.add_sample(id++, Sample{{b[0] * shell, b[1] * shell, b[2]}, {0, 0, 0}}, frame.weight);
    frames.end_frame(t, omega);
    t += frame.weight;
  }
  return frames;
}

}  // namespace

TEST_CASE("a place is covered for the time that beads are there, however many") {
  const AnalyzerContext context = mill(3);
  // Two beads one behind the other for three parts of the time, one beside it for one part.
  const Frames frames = frames_of({{{{0.5, 0, 0.05}, {0.5, 0, 0.15}}, 0.03}, {{{-0.5, 0, 0.05}, {-0.5, 0, 0.15}}, 0.01}}, 3);
  const Outcome o = Analyzer("silhouette", context, "cells=1000").of(frames);
  const auto covered = values(o, "covered");
  REQUIRE(covered.size() == 1000 * 1000);
  CHECK_THAT(covered[500 * 1000 + 750], WithinAbs(0.75, 1e-12));
  CHECK_THAT(covered[500 * 1000 + 250], WithinAbs(0.25, 1e-12));
  CHECK(covered[750 * 1000 + 500] == 0);
  const double disc = std::pow(Frames::kBeadRadius / context.mill_radius, 2);
  CHECK_THAT(number(o, "area"), WithinRel(100 * disc, 0.02));
}

TEST_CASE("directions count in the turning sense, and a free ring has none") {
  for (const double omega : {3.0, -3.0}) {
    const double side = omega > 0 ? 1 : -1;
    Seen arc{{}, 0.01};  // about 45 degrees past 6 o'clock
    for (double angle = 35 * kRadians; angle < 55.5 * kRadians; angle += kRadians)
      arc.beads.push_back({side * 0.6 * std::sin(angle), -0.6 * std::cos(angle), 0.1});
    const Outcome o = Analyzer("silhouette", mill(omega), "cells=400").of(frames_of({arc}, omega));
    const auto direction = values(o, "direction"), share = values(o, "share");
    bool found = false;
    for (std::size_t k = 0; k < share.size(); ++k) {
      if (share[k] > 1) {
        CHECK_THAT(direction[k], WithinAbs(45, 1));
        found = true;
      } else {
        CHECK(std::isnan(direction[k]));
      }
    }
    CHECK(found);
  }
}

TEST_CASE("a part of the axis that is asked for hides nothing of the rest") {
  const Outcome o =
      Analyzer("silhouette", mill(3), "cells=400 z_from=0 z_to=0.1").of(frames_of({{{{0.5, 0, 0.05}, {-0.5, 0, 0.2}}, 0.01}}, 3));
  const auto covered = values(o, "covered");
  CHECK(covered[200 * 400 + 300] == 1);
  CHECK(covered[200 * 400 + 100] == 0);
}
