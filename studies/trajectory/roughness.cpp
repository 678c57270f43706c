// How strongly to smooth: one roughness q per coordinate that makes the whole run most likely, times a factor per interval.
//
// The factor m of an interval makes the points around it most likely: where the data put more into the random accelerations than m lets
// expect (Evidence), m grows. Summed over a window of some intervals and over the three coordinates, with a prior worth one degree of
// freedom that m is 1:
//   m ← (1 + Σ m·found) / (1 + Σ expected)
// Two rounds do nearly all of it.
#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/trajectory/pieces.hpp"

namespace millscope::trajectory {
namespace {

constexpr int kRounds = 2;
constexpr double kPrior = 1;     // degrees of freedom
constexpr double kMemory = 3.3;  // median intervals: e-folding time of the window
constexpr double kLeastFactor = 1e-4;

/// Some stretches spread evenly over the run.
std::vector<Span> sample_of(const std::vector<Span>& spans) {
  constexpr std::size_t kLongest = 500, kPoints = 10000;
  std::vector<Span> cut;
  std::size_t total = 0;
  for (const Span& span : spans) {
    for (std::size_t first = span.first; first + 6 <= span.last; first += kLongest) {
      cut.push_back({first, std::min(first + kLongest, span.last)});
      total += cut.back().size();
    }
  }
  const std::size_t stride = total / kPoints + 1;
  std::vector<Span> chosen;
  for (std::size_t k = 0; k < cut.size(); k += stride) chosen.push_back(cut[k]);
  return chosen;
}

/// Two-sided exponential window over the intervals: decay[i] lies between the middles of intervals i − 1 and i.
void spread(const std::vector<double>& decay, std::vector<double>& values) {
  const std::size_t n = values.size();
  double sum = 0;
  std::vector<double> backward(n);
  for (std::size_t i = n; i-- > 0;) {
    backward[i] = sum = values[i] + (i + 1 < n ? sum * decay[i + 1] : 0);
  }
  sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? sum * decay[i] : 0;
    sum = before + values[i];
    values[i] = before + backward[i];
  }
}

}  // namespace

double median_interval(const Points& points) {
  std::vector<double> some;
  const std::size_t stride = points.count / 1000 + 1;
  for (std::size_t i = 0; i + 1 < points.count; i += stride) some.push_back(points.time[i + 1] - points.time[i]);
  return base::quantile(some, 0.5);
}

Lanes likely_roughness(const recording::Run& run, const std::vector<Span>& spans, const Lanes& noise) {
  const std::vector<Span> sample = sample_of(spans);
  const auto cost = [&](const Lanes& log_q) {
    Lanes sum{};
    for (const Span& span : sample) {
      const Lanes one = misfit(points_of(run, span), noise, {std::exp(log_q[0]), std::exp(log_q[1]), std::exp(log_q[2])});
      for (std::size_t k = 0; k < 3; ++k) sum[k] += one[k];
    }
    return sum;
  };
  // Golden section over log q, from a bead at rest to one that is thrown about at 10 m/s every millisecond.
  constexpr double kGolden = 0.6180339887498949, kFinest = 0.05;
  const double bottom = std::log(1e-8), top = std::log(1e5);
  Lanes low{bottom, bottom, bottom}, high{top, top, top}, a, b;
  a.fill(top - kGolden * (top - bottom)), b.fill(bottom + kGolden * (top - bottom));
  Lanes cost_a = cost(a), cost_b = cost(b);
  const auto searches = [&](std::size_t k) { return high[k] - low[k] > kFinest; };
  while (searches(0) || searches(1) || searches(2)) {
    Lanes next{};
    std::array<bool, 3> below{};
    for (std::size_t k = 0; k < 3; ++k) {
      below[k] = cost_a[k] < cost_b[k];
      if (!searches(k)) next[k] = a[k];
      if (!searches(k)) continue;
      if (below[k])
        high[k] = b[k], b[k] = a[k], cost_b[k] = cost_a[k], next[k] = a[k] = high[k] - kGolden * (high[k] - low[k]);
      else
        low[k] = a[k], a[k] = b[k], cost_a[k] = cost_b[k], next[k] = b[k] = low[k] + kGolden * (high[k] - low[k]);
    }
    const Lanes found = cost(next);
    for (std::size_t k = 0; k < 3; ++k) (below[k] ? cost_a : cost_b)[k] = found[k];
  }
  Lanes roughness;
  for (std::size_t k = 0; k < 3; ++k) roughness[k] = std::exp((low[k] + high[k]) / 2);
  return roughness;
}

void smooth_adaptively(const Points& points, const Lanes& noise, const Lanes& roughness, Spline& spline) {
  const std::size_t n = points.count - 1;
  const double window = kMemory * median_interval(points);
  std::vector<double> decay(n), factor(n, 1.0), found(n), expected(n);
  for (std::size_t i = 1; i < n; ++i) decay[i] = std::exp(-(points.time[i + 1] - points.time[i - 1]) / (2 * window));
  std::vector<Evidence> evidence;
  for (int round = 0;; ++round) {
    smooth(points, noise, roughness, factor, spline, evidence);
    if (round == kRounds) return;
    for (std::size_t i = 0; i < n; ++i) found[i] = factor[i] * evidence[i].found, expected[i] = evidence[i].expected;
    spread(decay, found);
    spread(decay, expected);
    for (std::size_t i = 0; i < n; ++i) factor[i] = std::max(kLeastFactor, (kPrior + found[i]) / (kPrior + expected[i]));
  }
}

}  // namespace millscope::trajectory
