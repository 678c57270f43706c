// Means of correlated series, their standard errors, and whether a window is steady.
#pragma once

#include <span>

namespace millscope::run {

struct Mean {
  double value = 0;
  double standard_error = 0;
  double correlation_time = 0;  ///< integrated, in samples; 0.5 for independent ones
};

/// Mean of an evenly sampled series. The standard error is s √(2 τ/n) with the integrated autocorrelation time τ summed up to the first
/// lag W ≥ 5 τ (Sokal 1997), times 1 + (2 W + 1)/n because the series' own mean was taken off (Wolff 2004); NaN for fewer than 4 samples.
Mean correlated_mean(std::span<const double> series);

struct Steadiness {
  bool steady = false;
  double drift = 0;            ///< second half − first half, in the series' unit
  double standard_errors = 0;  ///< |drift| over its standard error
};

/// Compares the halves of a window: steady when they differ by less than three standard errors of the difference (of the series without
/// its linear trend), or by less than `tolerance` (relative to the mean), whichever is wider.
Steadiness steadiness(std::span<const double> series, double tolerance);

}  // namespace millscope::run
