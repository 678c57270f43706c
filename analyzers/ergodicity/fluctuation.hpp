// Do the time averages of single beads come together? The fluctuation metric of Thirumalai & Mountain (1993).
//
//   f̄_j(t)    time average of f over bead j from the start to t
//   Ω_f(t)  = 1/(N − 1) Σ_j (f̄_j(t) − f̄(t))²,   f̄(t) = 1/N Σ_j f̄_j(t)
//
// Ergodic: Ω_f(0)/Ω_f(t) → D t, D = 1/(2 τ), τ the integral correlation time of f along one bead. Not ergodic: Ω_f levels off at the
// variance of what the beads keep for ever. Two signs tell them apart:
//
//   exponent    −d ln Ω/d ln t over the last three quarters of the time                          1: as for independent samples, 0: level
//   persistent  cov_j(f̄_j over the first third, f̄_j over the last third)/Ω(T)                     0: forgotten, 1: kept
//
// Ergodic within the data: nothing persists beyond twice its error, and the exponent is at least 0.7. Not ergodic: most persists beyond
// twice its error and the exponent is at most 0.1. Anything else, fewer than eight beads and less than five turns of the mill cannot tell:
// the data are too short. To call a charge not ergodic they must also last twenty times
//
//   memory      τ = Δ Σ_l ρ_l up to the first zero, ρ_l: correlation at lag l Δ of what is left of f when each bead's own mean is taken out
//
// however level Ω_f is: within its memory a bead that mixes looks like one that never will.
#pragma once

#include <cmath>
#include <vector>

#include "analyzers/common/grid.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

/// Sums per window and bead of one quantity: time (s) and time × f, `stride` numbers apart.
struct WindowSums {
  const double* time;
  const double* value;
  std::int64_t windows, beads, stride;
  double t(std::int64_t window, std::int64_t bead) const { return time[(window * beads + bead) * stride]; }
  double v(std::int64_t window, std::int64_t bead) const { return value[(window * beads + bead) * stride]; }
};

/// Mean of f over windows from … to − 1, per bead; NaN where a bead was not seen.
inline std::vector<double> bead_means(const WindowSums& sums, std::int64_t from, std::int64_t to) {
  std::vector<double> means(as_size(sums.beads));
  for (std::int64_t bead = 0; bead < sums.beads; ++bead) {
    double time = 0, value = 0;
    for (std::int64_t w = from; w < to; ++w) time += sums.t(w, bead), value += sums.v(w, bead);
    element(means, bead) = ratio(value, time);
  }
  return means;
}

/// Covariance over the beads that both have; NaN with fewer than two.
inline double covariance(const std::vector<double>& a, const std::vector<double>& b) {
  double n = 0, mean_a = 0, mean_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i] + b[i])) continue;
    n += 1, mean_a += a[i], mean_b += b[i];
  }
  if (n < 2) return kNaN;
  mean_a /= n, mean_b /= n;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isnan(a[i] + b[i])) sum += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return sum / (n - 1);
}

struct Fluctuation {
  std::vector<double> elapsed, metric;  ///< s; Ω at the end of each window
  double exponent = kNaN, persistent = kNaN, persistent_error = kNaN;
  double rate = kNaN;       ///< Ω t, mean over the last half: variance of a time average over t is rate/t
  double diffusion = kNaN;  ///< D, 1/s
  double memory = 0;        ///< s, within the beads; 0: shorter than a window
  double distance = kNaN;   ///< rms over beads of |f̄_j − f̄| over its own standard error; 1: nothing but its noise
  double verdict = 0;       ///< 1 ergodic within the data, −1 not, 0 cannot tell
};

namespace detail {

inline void add_metric(const WindowSums& sums, Fluctuation& out) {
  std::vector<double> time(as_size(sums.beads), 0.0), value(time), means(time);
  for (std::int64_t w = 0; w < sums.windows; ++w) {
    double elapsed = 0, seen = 0;
    for (std::size_t bead = 0; bead < time.size(); ++bead) {
      time[bead] += sums.t(w, static_cast<std::int64_t>(bead));
      value[bead] += sums.v(w, static_cast<std::int64_t>(bead));
      means[bead] = ratio(value[bead], time[bead]);
      if (time[bead] > 0) elapsed += time[bead], seen += 1;
    }
    out.elapsed.push_back(ratio(elapsed, seen));
    out.metric.push_back(covariance(means, means));
  }
}

/// Slope of ln Ω against ln t over the windows after a quarter of the time; Ω·t and D over the last half.
inline void add_decay(double instant_variance, Fluctuation& out) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, product = 0, inverse = 0, late = 0;
  const double end = out.elapsed.back();
  for (std::size_t w = 0; w < out.metric.size(); ++w) {
    const double t = out.elapsed[w], metric = out.metric[w];
    if (!(t >= 0.25 * end && metric > 0)) continue;
    const double a = std::log(t), b = std::log(metric);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
    if (t >= 0.5 * end) late += 1, product += metric * t, inverse += instant_variance / (metric * t);
  }
  const double determinant = n * xx - x * x;
  if (determinant > 0) out.exponent = -(n * xy - x * y) / determinant;
  out.rate = ratio(product, late);
  out.diffusion = ratio(inverse, late);
}

/// Memory of the windows' means about each bead's own mean, s; `between`: variance between the beads.
inline double memory_within(const WindowSums& sums, double window, double between) {
  constexpr double kStill = 1e-3;  // of the variance between beads: they stand still in f
  const std::vector<double> means = bead_means(sums, 0, sums.windows);
  const auto beads = as_size(sums.beads), windows = as_size(sums.windows);
  std::vector<double> deviation(windows * beads);
  for (std::size_t i = 0; i < deviation.size(); ++i) {
    const auto w = static_cast<std::int64_t>(i / beads), bead = static_cast<std::int64_t>(i % beads);
    deviation[i] = ratio(sums.v(w, bead), sums.t(w, bead)) - means[i % beads];
  }
  double variance = 0, memory = 0;
  for (std::size_t lag = 0; lag < windows; ++lag) {
    double product = 0, pairs = 0;
    for (std::size_t i = 0; i + lag * beads < deviation.size(); ++i) {
      const double both = deviation[i] * deviation[i + lag * beads];
      if (!std::isnan(both)) product += both, pairs += 1;
    }
    const double covariance = ratio(product, pairs);
    if (lag == 0) {
      variance = covariance;
      if (!(variance > kStill * between)) return 0;
    } else if (!(covariance > 0)) {
      break;
    } else {
      memory += window * covariance / variance;
    }
  }
  return memory;
}

/// The beads' distances in units of their own noise, from eight stretches of each bead's time (Student's t with 7 degrees of freedom).
inline double distance_to_ensemble(const WindowSums& sums) {
  constexpr std::int64_t kStretches = 8;
  if (sums.windows < kStretches) return kNaN;
  std::vector<std::vector<double>> stretch;
  for (std::int64_t k = 0; k < kStretches; ++k) {
    stretch.push_back(bead_means(sums, sums.windows * k / kStretches, sums.windows * (k + 1) / kStretches));
  }
  const std::vector<double> means = bead_means(sums, 0, sums.windows);
  double all = 0, beads = 0;
  for (const double m : means) {
    if (!std::isnan(m)) all += m, beads += 1;
  }
  all = ratio(all, beads);
  double square = 0, count = 0;
  for (std::size_t bead = 0; bead < means.size(); ++bead) {
    double mean = 0, spread = 0;
    for (const auto& s : stretch) mean += s[bead] / kStretches;
    for (const auto& s : stretch) spread += (s[bead] - mean) * (s[bead] - mean);
    const double error = std::sqrt(spread / (kStretches * (kStretches - 1)));
    if (!(error > 0)) continue;
    square += (means[bead] - all) * (means[bead] - all) / (error * error);
    count += 1;
  }
  constexpr double kStudent = (kStretches - 1.0) / (kStretches - 3.0);  // variance of Student's t
  return std::sqrt(ratio(square, count) / kStudent);
}

}  // namespace detail

/// `instant_variance` of f over beads and times; `turn`: time of one turn of the mill, s.
inline Fluctuation find_fluctuation(const WindowSums& sums, double instant_variance, double turn) {
  constexpr double kDecays = 0.7, kLevel = 0.1, kKept = 0.5, kLeastBeads = 8, kLeastWindows = 8, kTurns = 5, kMemories = 20;
  Fluctuation out;
  detail::add_metric(sums, out);
  detail::add_decay(instant_variance, out);
  out.distance = detail::distance_to_ensemble(sums);

  const std::vector<double> first = bead_means(sums, 0, sums.windows / 3),
                            last = bead_means(sums, sums.windows - sums.windows / 3, sums.windows);
  const double kept = covariance(first, last), final_metric = out.metric.back();
  double beads = 0;
  for (std::size_t i = 0; i < first.size(); ++i) beads += !std::isnan(first[i] + last[i]);
  if (beads < kLeastBeads || static_cast<double>(sums.windows) < kLeastWindows || !(final_metric > 0)) return out;
  // Of a covariance of two independent normal quantities: √(var var/(N − 1)).
  out.persistent = kept / final_metric;
  out.persistent_error = std::sqrt(covariance(first, first) * covariance(last, last) / (beads - 1)) / final_metric;
  const double span = out.elapsed.back();
  out.memory = detail::memory_within(sums, span / static_cast<double>(sums.windows), final_metric);
  if (span < kTurns * turn) return out;
  const bool forgotten = out.persistent < 2 * out.persistent_error;
  if (forgotten && out.exponent >= kDecays) out.verdict = 1;
  const bool kept_for_ever = out.persistent - 2 * out.persistent_error > kKept;
  if (kept_for_ever && out.exponent <= kLevel && span >= kMemories * out.memory) out.verdict = -1;
  return out;
}

}  // namespace millscope::analyzers
