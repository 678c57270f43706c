// circulation on motions that are known.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kOmega = 6;

AnalyzerContext mill(double omega, std::int64_t beads) {
  AnalyzerContext c = study();
  c.omega = omega;
  c.largest_id = beads - 1;
  return c;
}

/// A bead that goes round the centre in times that follow each other in turn.
Motion uneven_circles(const std::vector<double>& lasts) {
  return [lasts](std::int64_t, double t) {
    double round = 0;
    for (const double s : lasts) round += s;
    t = std::fmod(t, round);
    std::size_t i = 0;
    while (t >= lasts[i]) t -= lasts[i++];
    const double rate = 2 * kPi / lasts[i], angle = rate * t, r = 0.03;
    return Sample{{0.07 + r * std::cos(angle), -0.06 + r * std::sin(angle), 0},
                  {-r * rate * std::sin(angle), r * rate * std::cos(angle), 0}};
  };
}

}  // namespace

TEST_CASE("a vortex circulates at its own rate, whichever way the mill turns") {
  const Motion motion = vortex_charge({0.07, -0.05, 0.05, 0.04, 9}, 100);
  const auto times = even_times(500, 0.01);
  for (const double sense : {1.0, -1.0}) {
    const Frames frames = all_beads(sense > 0 ? motion : mirrored(motion), 100, times, even_weights(500, 0.01), sense * kOmega);
    const Outcome o = Analyzer("circulation", mill(sense * kOmega, 100)).of(frames);
    CHECK_THAT(number(o, "circulation_rate"), WithinRel(9 / (2 * kPi), 0.01));
    CHECK_THAT(number(o, "circulations_per_turn"), WithinRel(1.5, 0.01));
    CHECK_THAT(number(o, "circulation_time_median"), WithinAbs(2 * kPi / 9, 0.011));
    // 4.99 s are 7.15 turns; the first passage of each bead only begins one.
    CHECK_THAT(number(o, "circulations_completed"), WithinAbs(615, 10));
    CHECK(number(o, "followed_fraction") == 1);
    CHECK_THAT(number(o, "circulation_centre_x"), WithinAbs(sense * 0.07, 1e-3));
  }
}

TEST_CASE("circulation times are right though blocks and gaps cut them") {
  const std::vector<double> lasts{0.5, 1.2, 0.7, 2.1, 0.9, 0.6, 1.6, 0.8, 0.55, 1.1};
  const auto times = even_times(200000, 0.005);
  const Frames frames = one_bead(uneven_circles(lasts), 0, times, even_weights(times.size(), 0.005), kOmega);
  const Analyzer analyzer("circulation", mill(kOmega, 1), "centre_x=0.07 centre_y=-0.06");
  const Outcome whole = analyzer.of(frames);
  Sums parts = analyzer.zero();
  for (std::size_t from = 0; from < 199000; from += 613) analyzer.add(frames.block(from, from + 613), parts);  // 3.06 s each
  const Outcome cut = analyzer.finish(parts);
  CHECK_THAT(number(whole, "mean_circulation_time"), WithinRel(1.005, 0.002));
  CHECK_THAT(number(cut, "mean_circulation_time"), WithinRel(1.005, 0.01));
  CHECK(number(whole, "unfinished_fraction") < 0.002);
  CHECK(number(cut, "unfinished_fraction") > 0.2);
  // Of the circulations seen whole in the cut data the long ones are too few; the corrected shares are those of the whole run.
  const auto& a = values(whole, "circulation_time_survival");
  const auto& b = values(cut, "circulation_time_survival");
  for (const double t : {0.65, 0.85, 1.15, 1.4, 1.8}) {
    const auto i = static_cast<std::size_t>(t / 0.02);
    INFO(t);
    CHECK_THAT(b[i], WithinAbs(a[i], 0.05));
  }
}

TEST_CASE("going back and forth over the line counts one circulation once") {
  // A slow turn with a fast swing of ±0.5 rad on top.
  const Motion motion = [](std::int64_t, double t) {
    const double angle = 2 * kPi * t + 0.5 * std::sin(40 * t), rate = 2 * kPi + 20 * std::cos(40 * t), r = 0.03;
    return Sample{{0.07 + r * std::cos(angle), -0.06 + r * std::sin(angle), 0},
                  {-r * rate * std::sin(angle), r * rate * std::cos(angle), 0}};
  };
  const Frames frames = one_bead(motion, 0, even_times(10001, 1e-3), even_weights(10001, 1e-3), kOmega);
  const Outcome o = Analyzer("circulation", mill(kOmega, 1), "centre_x=0.07 centre_y=-0.06").of(frames);
  CHECK_THAT(number(o, "circulations_completed"), WithinAbs(9, 1));
}

TEST_CASE("axial dispersion and correlation times of random motions come out") {
  constexpr double kStep = 0.01, kDispersion = 1e-4, kMemory = 0.1;
  constexpr std::size_t kFrames = 2000;
  constexpr std::int64_t kBeads = 60;
  Random random(7);
  std::vector<std::vector<double>> z(kBeads), v(kBeads);
  for (std::int64_t bead = 0; bead < kBeads; ++bead) {
    auto& w = v[bead];
    w = noise_with_memory(random, kFrames, kStep, kMemory);
    double place = 0.5;
    for (double& speed : w) {
      speed *= std::sqrt(kDispersion / kMemory);  // D = σ² τ
      place += speed * kStep;
      z[bead].push_back(place);
    }
  }
  const auto motion = [&](double period) {
    return [&, period](std::int64_t id, double t) {
      const auto i = static_cast<std::size_t>(std::lround(t / kStep)), b = static_cast<std::size_t>(id);
      const double angle = kOmega * t + static_cast<double>(id);
      const double place = period > 0 ? z[b][i] - period * std::floor(z[b][i] / period) : z[b][i];
      return Sample{{0.07 + 0.03 * std::cos(angle), -0.05 + 0.03 * std::sin(angle), place},
                    {-0.03 * kOmega * std::sin(angle), 0.03 * kOmega * std::cos(angle), v[b][i]}};
    };
  };
  const auto times = even_times(kFrames, kStep);
  AnalyzerContext c = mill(kOmega, kBeads);
  const Outcome free = Analyzer("circulation", c).of(all_beads(motion(0), kBeads, times, even_weights(kFrames, kStep), kOmega));
  CHECK_THAT(number(free, "axial_dispersion"), WithinRel(kDispersion, 0.15));
  CHECK_THAT(number(free, "axial_velocity_correlation_time"), WithinRel(kMemory, 0.15));
  CHECK_THAT(number(free, "axial_velocity_independent_samples"), WithinRel(kBeads * kFrames * kStep / (2 * kMemory), 0.15));
  CHECK_THAT(number(free, "axial_mixing_time"), WithinRel(0.27 * 0.27 / (kPi * kPi * kDispersion), 0.15));
  // A slice that is periodic along z tells the same.
  c.is_periodic = 1;
  c.mill_high = 0.02;
  const Outcome periodic = Analyzer("circulation", c).of(all_beads(motion(0.02), kBeads, times, even_weights(kFrames, kStep), kOmega));
  CHECK_THAT(number(periodic, "axial_dispersion"), WithinRel(number(free, "axial_dispersion"), 1e-6));
  CHECK(periodic.count("axial_mixing_time") == 0);
}

TEST_CASE("a block without a centre of circulation is left out, and said so") {
  const Motion straight = [](std::int64_t id, double t) {
    return Sample{{-0.1 + 0.2 * t, 0.001 * static_cast<double>(id), 0}, {0.2, 0, 0}};
  };
  const Outcome o =
      Analyzer("circulation", mill(kOmega, 10)).of(all_beads(straight, 10, even_times(50, 0.01), even_weights(50, 0.01), kOmega));
  CHECK(number(o, "followed_fraction") == 0);
  CHECK(std::isnan(number(o, "circulation_rate")));
  CHECK(std::isnan(number(o, "circulation_time_median")));
}
