// From sums to circulation times, axial dispersion and correlation times.
#pragma once

#include <vector>

#include "analyzers/circulation/series.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

/// Share of circulations that last longer than each edge (Kaplan & Meier 1958): Π (1 − d_i/n_i), d_i circulations completed in bin i, n_i
/// that were seen to last until it. A circulation that ends unseen in bin i (a gap, the end of a block) counts as seen until half of it.
/// NaN beyond the last bin that anything was seen in. bins + 1 numbers.
inline std::vector<double> survival(const double* completed, const double* unfinished, std::size_t bins) {
  std::vector<double> share(bins + 1, kNaN);
  double seen = 0;
  for (std::size_t i = 0; i <= bins; ++i) seen += completed[i] + unfinished[i];
  double still = 1;
  for (std::size_t i = 0; i < bins && seen > 0; ++i) {
    share[i] = still;
    const double at_risk = seen - 0.5 * unfinished[i];
    if (at_risk > 0) still *= 1 - std::fmin(1, completed[i] / at_risk);
    seen -= completed[i] + unfinished[i];
    share[i + 1] = still;
  }
  return share;
}

/// Time that the share `part` of circulations is shorter than; NaN where the data do not reach.
inline double survival_quantile(const std::vector<double>& share, const Bins& bins, double part) {
  for (std::int64_t i = 0; i < bins.count; ++i) {
    const double before = element(share, i), after = share[as_size(i) + 1];
    if (before > 1 - part && after <= 1 - part) return bins.edge(i) + bins.width() * (before - 1 + part) / (before - after);
  }
  return kNaN;
}

/// Mean square axial displacement against the lag, and the line msd = 2 D lag + offset over a range of lags.
struct Spread {
  std::vector<double> lag, msd;
  double dispersion = kNaN;  ///< D, m²/s
  double offset = kNaN;      ///< m²
};

inline Spread find_spread(const std::vector<std::int64_t>& lags, double step, const double* sums, double from, double to) {
  Spread spread;
  double n = 0, t = 0, tt = 0, m = 0, tm = 0;
  int used = 0;
  for (std::size_t l = 0; l < lags.size(); ++l) {
    const double* sum = sums + kSpreadMoments * static_cast<std::int64_t>(l);
    const double lag = static_cast<double>(lags[l]) * step, msd = ratio(sum[kSpreadSquare], sum[kSpreadPairs]);
    spread.lag.push_back(lag);
    spread.msd.push_back(msd);
    if (lag < from || lag > to || !(sum[kSpreadPairs] > 0)) continue;
    const double w = 1 / (lag * lag);  // the scatter of a mean square displacement grows with the lag
    n += w, t += w * lag, tt += w * lag * lag, m += w * msd, tm += w * lag * msd;
    ++used;
  }
  const double determinant = n * tt - t * t;
  if (used < 3 || !(determinant > 0)) return spread;
  spread.dispersion = 0.5 * (n * tm - t * m) / determinant;
  spread.offset = (tt * m - t * tm) / determinant;
  return spread;
}

/// Correlation with itself against the lag; NaN where no pair was seen.
inline std::vector<double> correlation(const double* sums, std::int64_t lags) {
  std::vector<double> all(as_size(lags), kNaN);
  for (std::int64_t l = 0; l < lags; ++l) {
    const double* sum = sums + kCorrelationMoments * l;
    const double n = sum[kPairs];
    if (!(n > 0)) continue;
    const double head = sum[kHead] / n, tail = sum[kTail] / n;
    const double spread = std::sqrt((sum[kHeadSquare] / n - head * head) * (sum[kTailSquare] / n - tail * tail));
    if (spread > 0) element(all, l) = (sum[kProduct] / n - head * tail) / spread;
  }
  return all;
}

/// Integral correlation time over the longest lag L that was seen, τ = Δ (1/2 + Σ (1 − l/L) ρ_l): a mean over L has the variance
/// 2 τ σ²/L, also where ρ swings with the circulation (Priestley 1981). Memory that outlasts L is not in it. NaN where τ > L/6.
inline double correlation_time(const std::vector<double>& rho, double step) {
  constexpr double kWindow = 6;
  std::size_t seen = 1;
  while (seen < rho.size() && !std::isnan(rho[seen])) ++seen;
  double tau = 0.5 * step;
  for (std::size_t l = 1; l < seen; ++l) tau += step * (1 - static_cast<double>(l) / static_cast<double>(seen)) * rho[l];
  return seen > 2 && kWindow * tau < static_cast<double>(seen) * step ? tau : kNaN;
}

}  // namespace millscope::analyzers
