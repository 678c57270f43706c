// How strongly to smooth: one roughness q per coordinate that makes the whole run most likely, times a factor per interval.
//
// The factor m of an interval makes the points around it most likely: where the data put more into the random accelerations than m lets
// expect (Evidence), m grows. Summed over a window of some intervals and over the three coordinates, with a prior worth one degree of
// freedom that m is 1:
//   m ← (1 + Σ m·found) / (1 + Σ expected)
// Two rounds do nearly all of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

/// The least cost over log q, from a bead at rest to one that is thrown about at 10 m/s every millisecond: three values a step apart move
/// on until the middle one is the least, and the parabola through them has its vertex there; the same once more with a fine step. Where
/// the roughness is known about, with the fine step alone.
class Search {
 public:
  explicit Search(double begin) {
    if (begin > 0) middle_ = std::log(begin), step_ = kFine;
  }
  bool done() const { return done_; }
  /// Where the cost is asked for; of a search that is done, what it found.
  double next() const { return done_ ? middle_ : middle_ + offset(missing()) * step_; }
  void take(double cost) {
    if (done_) return;
    cost_[missing()] = cost;
    if (missing() == kPoints) judge();
  }

 private:
  static constexpr double kCoarse = 3, kFine = 0.5;
  static constexpr std::size_t kPoints = 3;
  static double offset(std::size_t point) { return static_cast<double>(point) - 1; }
  std::size_t missing() const {
    std::size_t k = 0;
    while (k < kPoints && cost_[k]) ++k;
    return k;
  }

  void judge() {
    const double before = *cost_[0], here = *cost_[1], behind = *cost_[2];
    if (before < here || behind < here) {
      const bool back = before < behind;
      middle_ += back ? -step_ : step_;
      cost_ = back ? Costs{std::nullopt, before, here} : Costs{here, behind, std::nullopt};
      const double bottom = std::log(1e-8), top = std::log(1e5);
      done_ = middle_ <= bottom || middle_ >= top;
      middle_ = std::clamp(middle_, bottom, top);
      return;
    }
    const double bend = before - 2 * here + behind;
    if (bend > 0 && std::isfinite(bend)) middle_ += 0.5 * step_ * (before - behind) / bend;
    done_ = step_ == kFine;
    step_ = kFine;
    cost_ = {};
  }

  using Costs = std::array<std::optional<double>, kPoints>;
  double middle_ = 0, step_ = kCoarse;
  Costs cost_;
  bool done_ = false;
};

}  // namespace

double median_interval(const Points& points) {
  std::vector<double> some;
  const std::size_t stride = points.count / 1000 + 1;
  for (std::size_t i = 0; i + 1 < points.count; i += stride) some.push_back(points.time[i + 1] - points.time[i]);
  return base::quantile(some, 0.5);
}

Lanes likely_roughness(const recording::Run& run, const std::vector<Span>& spans, const RoughnessSearch& by) {
  const std::vector<Span> sample = sample_of(spans);
  const auto cost = [&](const Lanes& log_q) {
    Lanes sum{};
    for (const Span& span : sample) {
      const Lanes one = misfit(points_of(run, span), by.noise, {std::exp(log_q[0]), std::exp(log_q[1]), std::exp(log_q[2])});
      for (std::size_t k = 0; k < 3; ++k) sum[k] += one[k];
    }
    return sum;
  };
  std::array<Search, 3> search{Search(by.begin[0]), Search(by.begin[1]), Search(by.begin[2])};
  while (!search[0].done() || !search[1].done() || !search[2].done()) {
    const Lanes found = cost({search[0].next(), search[1].next(), search[2].next()});
    for (std::size_t k = 0; k < 3; ++k) search[k].take(found[k]);
  }
  return {std::exp(search[0].next()), std::exp(search[1].next()), std::exp(search[2].next())};
}

void smooth_adaptively(const Points& points, const Lanes& noise, const Lanes& roughness, Spline& spline) {
  const std::size_t n = points.count - 1;
  const double window = kMemory * median_interval(points);
  std::vector<double> decay(n), factor(n, 1.0), found(n), expected(n);
  for (std::size_t i = 1; i < n; ++i) decay[i] = std::exp(-(points.time[i + 1] - points.time[i - 1]) / (2 * window));
  std::vector<Evidence> evidence;
  for (int round = 0; round < kRounds; ++round) {
    weigh_evidence(points, {noise, roughness, factor}, evidence);
    for (std::size_t i = 0; i < n; ++i) found[i] = factor[i] * evidence[i].found, expected[i] = evidence[i].expected;
    spread(decay, found);
    spread(decay, expected);
    for (std::size_t i = 0; i < n; ++i) factor[i] = std::max(kLeastFactor, (kPrior + found[i]) / (kPrior + expected[i]));
  }
  smooth(points, {noise, roughness, factor}, spline);
}

}  // namespace millscope::trajectory
