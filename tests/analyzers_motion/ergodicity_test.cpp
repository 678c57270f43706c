// ergodicity on beads that mix, that never mix, and that are watched too briefly.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kOmega = 6;
constexpr std::int64_t kBeads = 150;

/// Beads whose place and speed wander about means that all share, with correlation time tau.
Frames wanderers(double tau, double step, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::vector<double>> x, y, u;
  for (std::int64_t bead = 0; bead < kBeads; ++bead) {
    x.push_back(noise_with_memory(random, count, step, tau));
    y.push_back(noise_with_memory(random, count, step, tau));
    u.push_back(noise_with_memory(random, count, step, tau));
  }
  const Motion motion = [&](std::int64_t id, double t) {
    const auto b = static_cast<std::size_t>(id), i = static_cast<std::size_t>(std::lround(t / step));
    return Sample{{0.06 + 0.02 * x[b][i], -0.05 + 0.02 * y[b][i], 0}, {1 + 0.2 * u[b][i], 0, 0}};
  };
  return all_beads(motion, kBeads, even_times(count, step), even_weights(count, step), kOmega);
}

AnalyzerContext mill(double end) {
  AnalyzerContext c = study();
  c.omega = kOmega;
  c.largest_id = kBeads - 1;
  c.start = 0;
  c.end = end;
  return c;
}

}  // namespace

TEST_CASE("a charge that mixes is ergodic, and the time for a power is that of its memory") {
  constexpr double kMemory = 0.2, kEnd = 60;
  const Outcome o = Analyzer("ergodicity", mill(kEnd)).of(wanderers(kMemory, 0.04, 1500, 1));
  CHECK(number(o, "verdict") == 1);
  for (const char* name : {"x", "speed", "depth"}) {
    INFO(name);
    CHECK_THAT(number(o, std::string(name) + "_exponent"), WithinAbs(1, 0.2));
    CHECK_THAT(number(o, std::string(name) + "_distance"), WithinAbs(1, 0.25));
  }
  CHECK_THAT(number(o, "x_diffusion"), WithinRel(1 / (2 * kMemory), 0.2));
  CHECK_THAT(number(o, "time_for_power_1_percent"), WithinRel(2 * kMemory * 0.02 * 0.02 / std::pow(0.01 * 0.06, 2), 0.2));
  CHECK_THAT(number(o, "time_for_power_5_percent") * 25, WithinRel(number(o, "time_for_power_1_percent"), 1e-9));
  CHECK_THAT(number(o, "power_error_in_an_hour"), WithinRel(0.01 * std::sqrt(number(o, "time_for_power_1_percent") / 3600), 1e-9));
  const AnalyzerContext c = mill(kEnd);
  CHECK_THAT(number(o, "power_all"), WithinRel(c.charge_mass * 9.81 * 0.06 * kOmega, 0.01));
  CHECK(values(o, "power_single").size() == 3);
  for (const double p : values(o, "power_single")) CHECK_THAT(p, WithinRel(number(o, "power_all"), 0.15));
}

TEST_CASE("a centrifuging charge is not ergodic") {
  const auto times = even_times(600, 0.02);
  const Outcome o =
      Analyzer("ergodicity", mill(12)).of(all_beads(turning_disc(kBeads, 0.148, kOmega), kBeads, times, even_weights(600, 0.02), kOmega));
  CHECK(number(o, "verdict") == -1);
  CHECK(number(o, "depth_verdict") == -1);
  CHECK_THAT(number(o, "depth_exponent"), WithinAbs(0, 0.01));
  CHECK_THAT(number(o, "depth_persistent"), WithinAbs(1, 0.01));
  CHECK(std::isnan(number(o, "time_for_power_1_percent")));
}

TEST_CASE("data shorter than the memory of the charge cannot tell") {
  const Outcome o = Analyzer("ergodicity", mill(6)).of(wanderers(6, 0.02, 300, 2));
  CHECK(number(o, "verdict") == 0);
}

TEST_CASE("what has not yet been forgotten is not taken for what never will be") {
  // A memory of 200 s watched for 12 s: the fluctuation is level and all of it persists, as in a charge that centrifuges.
  const Outcome slow = Analyzer("ergodicity", mill(12)).of(wanderers(200, 0.04, 300, 4));
  for (const char* name : {"x", "speed", "depth"}) {
    INFO(name);
    CHECK(number(slow, std::string(name) + "_persistent") > 0.8);
    CHECK(number(slow, std::string(name) + "_verdict") == 0);
  }
  // Two turns of a charge that does centrifuge.
  const auto times = even_times(100, 0.02);
  const Outcome brief =
      Analyzer("ergodicity", mill(2)).of(all_beads(turning_disc(kBeads, 0.148, kOmega), kBeads, times, even_weights(100, 0.02), kOmega));
  CHECK(number(brief, "verdict") == 0);
  CHECK(number(brief, "depth_persistent") > 0.9);
}

TEST_CASE("few beads cannot tell") {
  AnalyzerContext c = mill(20);
  c.largest_id = 2;
  const auto times = even_times(500, 0.04);
  const Outcome o = Analyzer("ergodicity", c).of(all_beads(turning_disc(3, 0.14, kOmega), 3, times, even_weights(500, 0.04), kOmega));
  CHECK(number(o, "verdict") == 0);
}

TEST_CASE("windows add up over blocks, and the mirror image tells the same") {
  const Frames frames = wanderers(0.2, 0.04, 500, 3);
  const Analyzer analyzer("ergodicity", mill(20));
  const Outcome whole = analyzer.of(frames);
  Sums sums = analyzer.zero();
  for (std::size_t from = 0; from < 500; from += 125) analyzer.add(frames.block(from, from + 125), sums);
  const Outcome cut = analyzer.finish(sums);
  for (const char* name : {"verdict", "x_exponent", "speed_distance", "depth_persistent", "power_all", "single_power_error"}) {
    INFO(name);
    CHECK_THAT(number(cut, name), WithinRel(number(whole, name), 1e-9));
  }
  Frames mirror = frames;
  for (double& x : mirror.position[0]) x = -x;
  AnalyzerContext c = mill(20);
  c.omega = -kOmega;
  const Outcome other = Analyzer("ergodicity", c).of(mirror);
  CHECK_THAT(number(other, "power_all"), WithinRel(number(whole, "power_all"), 1e-9));
  CHECK_THAT(number(other, "x_exponent"), WithinRel(number(whole, "x_exponent"), 1e-9));
}

TEST_CASE("the time for a cell follows from its visits") {
  // Beads jump at random: every frame is a visit of its own, so a cell with the share p needs 1/(p e²) frames.
  Random random(9);
  const Motion motion = [&](std::int64_t, double) {
    const double r = 0.14 * std::sqrt(random.uniform()), angle = 2 * kPi * random.uniform();
    return Sample{{r * std::cos(angle), r * std::sin(angle), 0}, {0.1, 0, 0}};
  };
  constexpr double kStep = 0.02;
  const Outcome o =
      Analyzer("ergodicity", mill(10), "cells=10").of(all_beads(motion, kBeads, even_times(500, kStep), even_weights(500, kStep), kOmega));
  CHECK_THAT(number(o, "revisit_inflation"), WithinAbs(1, 0.15));
  const double share = 0.03 * 0.03 / (kPi * 0.14 * 0.14);
  CHECK_THAT(values(o, "cell_time_10_percent")[5 * 10 + 5], WithinRel(kStep / share / 0.01, 0.2));
}
