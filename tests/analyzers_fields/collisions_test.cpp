#include <catch2/catch.hpp>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

namespace {

constexpr const char* kPairs[] = {"glass~glass", "glass~Liner 2"};
constexpr double kEdges[] = {1e-6, 1e-5, 1e-4, 1e-3};

AnalyzerContext with_impacts() {
  AnalyzerContext context = study();
  context.has |= kHasImpacts;
  context.impact_pair_count = 2;
  context.impact_bin_count = 3;
  context.impact_pair = kPairs;
  context.impact_energy_edge = kEdges;
  return context;
}

/// Counts that grow at 100, 10, 1 a second between beads and at 7, 5, 3 at the liner, from an arbitrary start.
Frames colliding(std::size_t frames_count) {
  Frames frames;
  frames.pairs = 2;
  frames.bins = 3;
  for (std::size_t f = 0; f < frames_count; ++f) {
    const double t = 2 + 0.1 * static_cast<double>(f);
    frames.end_frame(t, 6);
    for (const double rate : {100.0, 10.0, 1.0, 7.0, 5.0, 3.0}) frames.impacts.push_back(1000 + rate * (t - 2));
  }
  return frames;
}

}  // namespace

TEST_CASE("collisions per time, pair and bin of energy") {
  const Analyzer analyzer("collision_energy", with_impacts());
  const Outcome o = analyzer.of(colliding(31));
  CHECK(values(o, "energy_edges") == std::vector<double>(std::begin(kEdges), std::end(kEdges)));
  const double expected[] = {100, 10, 1, 7, 5, 3};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(values(o, "rate_glass_glass")[i] == Approx(expected[i]));
    CHECK(values(o, "rate_glass_liner_2")[i] == Approx(expected[3 + i]));
    CHECK(values(o, "rate_all")[i] == Approx(expected[i] + expected[3 + i]));
  }
  CHECK(number(o, "collision_rate_glass_glass") == Approx(111));
  CHECK(number(o, "collision_rate_all") == Approx(126));
  const double middle = std::sqrt(10.0);
  CHECK(number(o, "impact_power_glass_glass") == Approx(middle * (100e-6 + 10e-5 + 1e-4)));
  CHECK(number(o, "mean_energy_glass_glass") == Approx(middle * 3e-4 / 111));
  CHECK(sum(values(o, "energy_rate_all")) == Approx(number(o, "impact_power_all")));
  CHECK(number(o, "collisions_per_bead") == Approx(126 / study().charge_count));
}

TEST_CASE("collisions of blocks that share a frame add up") {
  const Analyzer analyzer("collision_energy", with_impacts());
  const Frames frames = colliding(31);
  Sums parts = analyzer.zero(), once = analyzer.zero();
  analyzer.add(frames.block(0, 11), parts);
  analyzer.add(frames.block(10, 31), parts);
  analyzer.add(frames.block(), once);
  for (std::size_t a = 0; a < once.size(); ++a) {
    for (std::size_t i = 0; i < once[a].size(); ++i) CHECK(parts[a][i] == Approx(once[a][i]));
  }
}

TEST_CASE("frames without counts of collisions are refused") {
  CHECK_THROWS_WITH(Analyzer("collision_energy", study()), Catch::Contains("run the case again"));
}
