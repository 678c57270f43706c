// Gaps, dead time and evenness from the intervals between locations.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "studies/camera/estimate_parts.hpp"
#include "studies/camera/maximise.hpp"

namespace millscope::camera {
namespace {

constexpr std::size_t kMostIntervals = 4000;
constexpr double kCoarsestClock = 1.5e-4;  // s

std::vector<double> intervals_of(const recording::Recording& recording) {
  std::vector<double> result;
  for (const recording::Run& run : recording.runs) {
    for (std::size_t i = 1; i < run.size(); ++i) result.push_back(run.time[i] - run.time[i - 1]);
  }
  return result;
}

/// Likelihood of intervals between locations of which a share 1 − p is lost: an interval is the sum of m found ones with probability
/// p (1 − p)^{m−1}, each a dead time and a gamma-distributed rest.
class IntervalLikelihood {
 public:
  IntervalLikelihood(std::vector<double> intervals, double rate, double kept)
      : intervals_(std::move(intervals)), rate_(rate), kept_(kept) {}

  /// `p`: rate times dead time; logarithm of the shape. One term for each of kGroups parts.
  std::vector<double> operator()(const std::vector<double>& p) const {
    const double dead = p[0] / rate_, shape = std::exp(p[1]), scale = (1 / rate_ - dead) / shape;
    std::array<double, kMostLost> constant;
    for (std::size_t m = 1; m <= kMostLost; ++m) {
      const double order = static_cast<double>(m);
      constant[m - 1] = std::log(kept_) + (order - 1) * std::log1p(-kept_) - std::lgamma(order * shape) - order * shape * std::log(scale);
    }
    std::vector<double> terms(kGroups, 0.0);
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      double density = 0;
      for (std::size_t m = 1; m <= kMostLost; ++m) {
        const double order = static_cast<double>(m), rest = intervals_[i] - order * dead;
        if (rest <= 0) break;
        density += std::exp(constant[m - 1] + (order * shape - 1) * std::log(rest) - rest / scale);
      }
      terms[i * kGroups / intervals_.size()] += std::log(std::max(density, 1e-30));
    }
    return terms;
  }

 private:
  static constexpr std::size_t kGroups = 20, kMostLost = 8;
  std::vector<double> intervals_;
  double rate_, kept_;
};

/// How far the logarithm of the shape may rise from its lower bound until the likelihood has fallen as by one standard error.
double reach_of(const IntervalLikelihood& likelihood, const Fit& fit) {
  const auto total = [&](double log_shape) {
    const std::vector<double> terms = likelihood({fit.value[0], log_shape});
    return std::accumulate(terms.begin(), terms.end(), 0.0);
  };
  double reach = 1e-3;
  while (reach < 5 && total(fit.value[1] + reach) > fit.log_likelihood - 0.5) reach *= 1.2;
  return reach;
}

}  // namespace

CameraGaps estimate_gaps(const recording::Recording& recording, double limit) {
  CameraGaps gaps;
  gaps.limit = limit;
  double live = 0, beyond = 0;
  for (const double d : intervals_of(recording)) {
    if (d <= limit) {
      live += d;
      continue;
    }
    beyond += d - limit;
    ++gaps.count;
  }
  if (gaps.count == 0) {
    gaps.rate = {0, 3 / std::max(live, 1e-9)};  // none in this time: 95 % sure below 3 per live time
    return gaps;
  }
  // Exponential lengths have no memory: what lies beyond the limit has the mean of the whole.
  const double n = static_cast<double>(gaps.count), length = beyond / n, hidden = std::exp(limit / length);
  gaps.mean_length = {length, length / std::sqrt(n)};
  gaps.rate = {n / live * hidden, n / live * hidden / std::sqrt(n) * (1 + limit / length)};
  return gaps;
}

void estimate_intervals(CameraSampling& sampling, const recording::Recording& recording, const RateModel& model, double pause) {
  std::vector<double> all;
  for (const double d : intervals_of(recording)) {
    if (d <= pause) all.push_back(d);
  }
  const double seconds = std::accumulate(all.begin(), all.end(), 0.0), rate = model.rate.value;
  const double kept = std::clamp(static_cast<double>(all.size()) / seconds / rate, 0.05, 0.999);
  const double shortest = *std::min_element(all.begin(), all.end());
  std::vector<double> some;
  const std::size_t count = std::min(all.size(), kMostIntervals);
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  const double most_dead = std::min(0.999 * shortest * rate, 0.95);
  const IntervalLikelihood likelihood(std::move(some), rate, kept);
  const Fit fit = maximise(likelihood, {{0.5 * most_dead, 0, std::max(most_dead, 1e-9)}, {0.5, 0, std::log(1e4)}});
  const double shape = std::exp(fit.value[1]);
  sampling.shape = {shape, shape * (fit.value[1] > 0.01 ? fit.error(1) : reach_of(likelihood, fit))};
  // Chance alone keeps the shortest of n Poisson intervals 1/(n λ) above zero; a clock of 0.1 ms keeps it there, too.
  const double dead = fit.value[0] / rate, chance = 3 / (rate * static_cast<double>(all.size()));
  sampling.dead_time = dead > std::max(chance, kCoarsestClock) ? dead : 0.0;
}

}  // namespace millscope::camera
