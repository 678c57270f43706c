#include "studies/analysis/resample.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "millscope/observation_adapter.hpp"
#include "studies/analysis/results.hpp"

namespace millscope::analysis {
namespace {

constexpr double kReliableBlocks = 10;
constexpr double kRounding = 1e-12;  // relative: what adding the same numbers in another order changes

struct Spread {
  double mean = 0, variance = 0;
  std::size_t defined = 0;
};

Spread spread_of(std::span<const float> values) {
  Spread s;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    s.mean += value;
    ++s.defined;
  }
  if (s.defined < 2) return {kNaN, kNaN, s.defined};
  s.mean /= static_cast<double>(s.defined);
  for (const float value : values) s.variance += std::isnan(value) ? 0 : (value - s.mean) * (value - s.mean);
  s.variance /= static_cast<double>(s.defined - 1);
  return s;
}

/// Power sums of the influences and their lag-1 correlation.
struct Influence {
  double squares = 0, cubes = 0, fourths = 0;
  double correlation = kNaN;  ///< ρ, unbiased; NaN where too few neighbours
  bool significant = false;
};

Influence influence_of(std::span<const float> left_out, std::span<const std::uint8_t> follows) {
  Influence r;
  const double n = static_cast<double>(left_out.size());
  const double mean = spread_of(left_out).mean;
  double products = 0, before = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    const double u = std::isnan(left_out[i]) ? 0.0 : mean - left_out[i], square = u * u;
    r.squares += square;
    r.cubes += square * u;
    r.fourths += square * square;
    if (i > 0 && follows[i] != 0) products += u * before, ++pairs;
    before = u;
  }
  if (pairs < 5 || !(r.squares > 0)) return r;
  const double raw = products / static_cast<double>(pairs) / (r.squares / n);
  r.correlation = raw + (1 + 3 * raw) / n;
  r.significant = r.correlation > 2 / std::sqrt(static_cast<double>(pairs));
  return r;
}

double degrees_of_freedom(const Influence& influence, double n) {
  const double concentration = influence.fourths / (influence.squares * influence.squares);  // 1/n … 1: a single block
  const double inverse = concentration - 3 / n + 2 / (n - 1);
  const double freedom = inverse > 0 ? 2 / inverse : n - 1;
  return std::clamp(std::min(freedom, 3 * (1 / concentration - 1)), 1.0, n - 1);
}

/// Student's t at 95 %, one-sided. Computed in double: it is asked for every value of every map.
double student(double freedom) {
  using Double = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::quantile(boost::math::students_t_distribution<double, Double>(freedom), 0.95);
}

}  // namespace

std::vector<std::uint32_t> draw_counts(std::size_t blocks, std::size_t draws, std::uint64_t seed) {
  std::vector<std::uint32_t> counts(blocks * draws, 0);
  Random random(seed ^ 0x6472617773ULL);  // a stream of its own
  for (std::size_t b = 0; b < draws; ++b) {
    for (std::size_t k = 0; k < blocks; ++k) {
      const auto at = std::min(blocks - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks)));
      ++counts[b * blocks + at];
    }
  }
  return counts;
}

std::vector<float> influence_draws(std::span<const float> left_out, std::span<const std::uint32_t> counts) {
  const std::size_t n = left_out.size();
  const double mean = spread_of(left_out).mean, part = static_cast<double>(n - 1) / static_cast<double>(n);
  std::vector<float> draws(n > 0 ? counts.size() / n : 0, 0.0F);
  for (std::size_t b = 0; b < draws.size(); ++b) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isnan(left_out[i])) sum += counts[b * n + i] * (mean - left_out[i]);
    }
    draws[b] = static_cast<float>(part * sum);
  }
  return draws;
}

Uncertainty uncertainty(double value, std::span<const float> draws, std::span<const float> left_out,
                        std::span<const std::uint8_t> follows) {
  const double n = static_cast<double>(left_out.size());
  Uncertainty u{kNaN, kNaN, kNaN, 0, kFewBlocks | kNoUncertainty, kNaN};
  if (left_out.size() < 2 || std::isnan(value)) return u;
  const Spread spread = spread_of(draws);
  const bool needs_one = std::any_of(left_out.begin(), left_out.end(), [](float v) { return std::isnan(v); });
  const Influence influence = influence_of(left_out, follows);
  // Undefined without one of the blocks and blind to the others: all rests on that block.
  if (spread.defined < 2 || (needs_one && !(influence.squares > 0))) {
    u.effective_blocks = 1;
    u.flags |= kOftenUndefined;
    return u;
  }
  const bool often_undefined = needs_one || static_cast<double>(spread.defined) < 0.9 * static_cast<double>(draws.size());
  u.flags = often_undefined ? kOftenUndefined : 0;
  if (!(influence.squares > 0) || !(std::sqrt(spread.variance) > kRounding * std::fabs(value))) {  // the same in every block
    u.sem = 0;
    u.low = u.high = value;
    u.effective_blocks = n;
  } else {
    const double wider = widening(influence.correlation);
    const double freedom = degrees_of_freedom(influence, n), t = student(freedom);
    u.correlation = influence.correlation;
    u.sem = std::sqrt(n / (n - 1) * wider * spread.variance);
    const double skewness = influence.cubes / (6 * std::pow(influence.squares, 1.5));
    const double shift = std::clamp(skewness * (1 + 2 * t * t), -t / 2, t / 2);
    u.low = value + u.sem * (shift - t);
    u.high = value + u.sem * (shift + t);
    u.effective_blocks = std::min(n, freedom + 1) / wider;
    if (influence.significant) u.flags |= kCorrelated;
  }
  if (u.effective_blocks < kReliableBlocks) u.flags |= kFewBlocks;
  return u;
}

double widening(double correlation) {
  const double r = std::isnan(correlation) ? 0 : std::clamp(correlation, 0.0, 0.9);
  return (1 + r) / (1 - r);
}

}  // namespace millscope::analysis
