#include "studies/analysis/resample.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "analysis/support.hpp"
#include "analyzers/ergodicity/fluctuation.hpp"
#include "millscope/random.hpp"
#include "studies/analysis/resampled_sums.hpp"
#include "studies/analysis/results.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr std::size_t kDraws = 200;

/// A mean over blocks (sum and weight of each) with its uncertainty, the way the host makes it.
analysis::Uncertainty of_mean(const std::vector<double>& sums, const std::vector<double>& weights, std::uint64_t seed) {
  const std::size_t n = sums.size();
  const double all = std::accumulate(sums.begin(), sums.end(), 0.0), weight = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double value = all / weight;
  const std::vector<std::uint32_t> counts = analysis::draw_counts(n, kDraws, seed);
  std::vector<float> draws, left_out;
  for (std::size_t b = 0; b < kDraws; ++b) {
    double s = 0, w = 0;
    for (std::size_t i = 0; i < n; ++i) {
      s += counts[b * n + i] * sums[i];
      w += counts[b * n + i] * weights[i];
    }
    draws.push_back(static_cast<float>(s / w - value));
  }
  for (std::size_t i = 0; i < n; ++i) left_out.push_back(static_cast<float>((all - sums[i]) / (weight - weights[i]) - value));
  std::vector<std::uint8_t> follows(n, 1);
  follows[0] = 0;
  return analysis::uncertainty(value, draws, left_out, follows);
}

/// Fraction of the intervals of many trials that hold the truth, for blocks of `length` values of f(x).
template <class F>
double coverage(std::size_t blocks, std::size_t length, double phi, double truth, F&& f, int trials = 400) {
  int hits = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<double> x = autoregressive(blocks * length, phi, 1000 + static_cast<std::uint64_t>(trial));
    std::vector<double> sums(blocks, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) sums[i / length] += f(x[i]);
    const analysis::Uncertainty u = of_mean(sums, std::vector<double>(blocks, static_cast<double>(length)), 7);
    hits += u.low <= truth && truth <= u.high ? 1 : 0;
  }
  return static_cast<double>(hits) / trials;
}

double itself(double x) { return x; }

}  // namespace

TEST_CASE("intervals hold with 90 % where blocks are three autocorrelation times") {
  constexpr double phi = 0.9;  // 9.5 steps
  CHECK_THAT(coverage(20, 29, phi, 0, itself), WithinAbs(0.90, 0.05));
  CHECK_THAT(coverage(64, 29, phi, 0, itself), WithinAbs(0.90, 0.05));
  // A skewed quantity: exp(x) has the mean √e.
  CHECK_THAT(coverage(64, 29, phi, std::exp(0.5), [](double x) { return std::exp(x); }), WithinAbs(0.90, 0.05));
  // An event that is seen in one block of three.
  CHECK_THAT(coverage(40, 29, phi, 0.5 * std::erfc(1.8 / std::sqrt(2)), [](double x) { return x > 1.8 ? 1.0 : 0.0; }),
             WithinAbs(0.90, 0.06));
}

namespace {

/// Beads whose windows are independent: what `ergodicity` makes of them, and how often its intervals hold the truth.
struct BeadTrials {
  double variance = 0, exponent = 0;  ///< fraction of the intervals that hold
  double naive_ratio = 0, ratio = 0;  ///< of the standard error of the variance to its scatter over trials
};

BeadTrials bead_trials(std::int64_t beads, std::int64_t windows, std::size_t blocks, int trials) {
  using millscope::analyzers::find_fluctuation;
  BeadTrials result;
  std::vector<double> found;
  for (int trial = 0; trial < trials; ++trial) {
    const auto size = static_cast<std::size_t>(windows * beads);
    const std::vector<double> noise = autoregressive(size, 0, 500 + static_cast<std::uint64_t>(trial));
    const std::vector<std::uint32_t> counts = analysis::draw_counts(blocks, kDraws, 1 + static_cast<std::uint64_t>(trial));
    // Metric at the end and exponent, of the windows with these weights.
    const auto of = [&](auto&& weight) {
      std::vector<double> time(size), value(size);
      for (std::size_t i = 0; i < size; ++i) {
        const double w = weight(i / static_cast<std::size_t>(beads) * blocks / static_cast<std::size_t>(windows));
        time[i] = w, value[i] = w * noise[i];
      }
      const auto f = find_fluctuation({time.data(), value.data(), windows, beads, 1}, 1, 0);
      return std::pair{f.metric.back(), f.exponent};
    };
    const auto [metric, exponent] = of([](std::size_t) { return 1.0; });
    std::vector<float> metric_without, exponent_without, resampled;
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto [m, e] = of([&](std::size_t block) { return block == b ? 0.0 : 1.0; });
      metric_without.push_back(static_cast<float>(m - metric)), exponent_without.push_back(static_cast<float>(e - exponent));
    }
    for (std::size_t d = 0; trial < 20 && d < 50; ++d) {
      const double m = of([&](std::size_t block) { return static_cast<double>(counts[d * blocks + block]); }).first;
      resampled.push_back(static_cast<float>(m / metric));
    }
    std::vector<std::uint8_t> follows(blocks, 1);
    follows[0] = 0;
    const analysis::Uncertainty m =
        analysis::uncertainty(metric, analysis::influence_draws(metric_without, counts), metric_without, follows);
    const analysis::Uncertainty e =
        analysis::uncertainty(exponent, analysis::influence_draws(exponent_without, counts), exponent_without, follows);
    const double truth = 1.0 / static_cast<double>(windows);
    result.variance += (m.low <= truth && truth <= m.high) / static_cast<double>(trials);
    result.exponent += (e.low <= 1 && 1 <= e.high) / static_cast<double>(trials);
    result.ratio += m.sem / trials;
    for (const float r : resampled) result.naive_ratio += static_cast<double>(r) / 1000;
    found.push_back(metric);
  }
  const double mean = std::accumulate(found.begin(), found.end(), 0.0) / trials;
  double square = 0;
  for (const double f : found) square += (f - mean) * (f - mean) / (trials - 1);
  result.ratio /= std::sqrt(square);
  return result;
}

}  // namespace

TEST_CASE("a spread between beads gets its error from the blocks that are left out") {
  const BeadTrials t = bead_trials(60, 40, 20, 150);
  // Drawn with replacement a block's own noise counts twice: the resampled variance between beads is nearly twice what it should be.
  CHECK_THAT(t.naive_ratio, WithinAbs(1.95, 0.15));
  CHECK(t.variance >= 0.88);
  CHECK(t.exponent >= 0.85);
  CHECK(t.ratio > 0.95);
  CHECK(t.ratio < 1.7);
  WARN("intervals hold " << t.variance << " (variance), " << t.exponent << " (exponent); error over scatter " << t.ratio);
}

TEST_CASE("how often the intervals hold, as a table", "[.coverage]") {
  constexpr double phi = 0.9;
  const auto exponential = [](double x) { return std::exp(x); };
  const auto rare = [](double x) { return x > 1.8 ? 1.0 : 0.0; };
  const double seldom = 0.5 * std::erfc(1.8 / std::sqrt(2));
  struct Row {
    const char* what;
    std::size_t blocks;
    double holds;
  };
  const Row rows[] = {{"memory, blocks of 3 tau", 10, coverage(10, 29, phi, 0, itself, 2000)},
                      {"memory, blocks of 3 tau", 20, coverage(20, 29, phi, 0, itself, 2000)},
                      {"memory, blocks of 3 tau", 64, coverage(64, 29, phi, 0, itself, 2000)},
                      {"memory, blocks of 1 tau", 64, coverage(64, 10, phi, 0, itself, 2000)},
                      {"its exponential (skewed)", 64, coverage(64, 29, phi, std::exp(0.5), exponential, 2000)},
                      {"a rare state (4 %)", 20, coverage(20, 29, phi, seldom, rare, 2000)},
                      {"a rare state (4 %)", 64, coverage(64, 29, phi, seldom, rare, 2000)}};
  for (const Row& row : rows) {
    std::printf("%-26s %2zu blocks: %.1f %%\n", row.what, row.blocks, 100 * row.holds);
    CHECK(row.holds > 0.8);
  }
}

TEST_CASE("a memory longer than the blocks widens the interval and says so") {
  constexpr double phi = 0.9;
  CHECK_THAT(coverage(64, 10, phi, 0, itself), WithinAbs(0.90, 0.05));  // blocks of one autocorrelation time
  const std::vector<double> x = autoregressive(640, phi, 3);
  std::vector<double> sums(64, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) sums[i / 10] += x[i];
  const analysis::Uncertainty u = of_mean(sums, std::vector<double>(64, 10.0), 1);
  CHECK((u.flags & analysis::kCorrelated) != 0);
  CHECK(u.effective_blocks < 40);
  CHECK(u.effective_blocks > 8);
}

TEST_CASE("the standard error of independent blocks is the textbook's") {
  const std::vector<double> sums = autoregressive(50, 0.0, 5);
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / 50;
  double square = 0;
  for (const double s : sums) square += (s - mean) * (s - mean);
  const analysis::Uncertainty u = of_mean(sums, std::vector<double>(50, 1.0), 1);
  CHECK_THAT(u.sem, WithinRel(std::sqrt(square / 49 / 50), 0.2));
  CHECK(u.low < mean);
  CHECK(u.high > mean);
  CHECK((u.flags & analysis::kFewBlocks) == 0);
}

TEST_CASE("few blocks, a single block and constants are told apart") {
  const analysis::Uncertainty few = of_mean({1, 2, 4, 3, 2}, {1, 1, 1, 1, 1}, 1);
  CHECK((few.flags & analysis::kFewBlocks) != 0);
  CHECK(std::isfinite(few.sem));
  const analysis::Uncertainty one = of_mean({1}, {1}, 1);
  CHECK((one.flags & analysis::kNoUncertainty) != 0);
  CHECK(std::isnan(one.sem));
  const analysis::Uncertainty constant = of_mean(std::vector<double>(20, 3.0), std::vector<double>(20, 1.5), 1);
  CHECK(constant.sem == 0);
  CHECK(constant.low == 2.0);
  CHECK(constant.flags == 0);
  // A cell that one block alone has seen: its mean says nothing of others.
  std::vector<double> sums(20, 0.0), weights(20, 0.0);
  sums[7] = 3;
  weights[7] = 1;
  const analysis::Uncertainty single = of_mean(sums, weights, 1);
  CHECK(std::isnan(single.sem));
  CHECK((single.flags & analysis::kOftenUndefined) != 0);
  CHECK(single.effective_blocks == 1);
  // What fails once without a block, but feels the others too, is doubtful and still has an interval.
  std::vector<float> draws, left_out;
  for (int b = 0; b < 200; ++b) draws.push_back(b % 3 == 0 ? std::nanf("") : 0.1F * static_cast<float>(b % 7 - 3));
  for (int i = 0; i < 20; ++i) left_out.push_back(i == 4 ? std::nanf("") : 0.01F * static_cast<float>(i % 5 - 2));
  const analysis::Uncertainty doubtful = analysis::uncertainty(1.0, draws, left_out, std::vector<std::uint8_t>(20, 1));
  CHECK((doubtful.flags & analysis::kOftenUndefined) != 0);
  CHECK(doubtful.low < 1.0);
  CHECK(doubtful.high > 1.0);
}

TEST_CASE("draws are the same everywhere and hold every block as often as chance says") {
  const std::vector<std::uint32_t> counts = analysis::draw_counts(10, 2000, 1);
  CHECK(counts == analysis::draw_counts(10, 2000, 1));
  CHECK(counts != analysis::draw_counts(10, 2000, 2));
  std::vector<double> total(10, 0.0);
  for (std::size_t b = 0; b < 2000; ++b) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 10; ++i) {
      sum += counts[10 * b + i];
      total[i] += counts[10 * b + i];
    }
    REQUIRE(sum == 10);
  }
  for (const double t : total) CHECK_THAT(t, WithinAbs(2000, 5 * std::sqrt(1800.0)));
}

TEST_CASE("resampled sums are those of the blocks one after the other, to the bit") {
  const std::size_t blocks = GENERATE(1, 2, 7, 30), columns = 19, draws = 21;
  Random random(blocks);
  std::vector<analysis::Row> rows(blocks, analysis::Row(columns + 2));
  for (analysis::Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = i % 3 == 1 ? 0 : random.normal();  // every third was never visited
  }
  const analysis::SumLayout::Part part{2, columns, {0}};
  const std::vector<std::uint32_t> counts = analysis::draw_counts(blocks, draws, 5);
  const analysis::ResampledSums sums(rows, part, counts, draws);
  std::size_t item = 0;
  for (std::size_t group = 0; group < sums.group_count(); ++group) {
    std::vector<double> found(analysis::ResampledSums::kGroup * columns, 0.0);
    sums.fill(group, found.data());
    for (std::size_t k = 0; k < analysis::ResampledSums::kGroup && item < draws + blocks; ++k, ++item) {
      for (std::size_t i = 0; i < columns; ++i) {
        double exact = 0, about = 0;
        for (std::size_t b = 0; b < blocks; ++b) {
          if (item < draws) exact += counts[item * blocks + b] * rows[b][2 + i];
          if (item >= draws && b != item - draws) about += rows[b][2 + i];
        }
        if (item < draws) CHECK(found[k * columns + i] == exact);
        if (item >= draws) CHECK_THAT(found[k * columns + i], WithinAbs(about, 1e-13));  // added in groups
      }
    }
  }
  CHECK(item == draws + blocks);
}
