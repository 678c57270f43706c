#include "kernel/run/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace millscope::run {

Mean correlated_mean(std::span<const double> x) {
  Mean m;
  const std::size_t n = x.size();
  if (n == 0) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), 0};
  for (const double v : x) m.value += v / static_cast<double>(n);
  if (n < 4) {
    m.standard_error = std::numeric_limits<double>::quiet_NaN();
    return m;
  }
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += (x[i] - m.value) * (x[i + lag] - m.value);
    return sum / static_cast<double>(n);
  };
  const double variance = covariance(0);
  m.correlation_time = 0.5;
  if (!(variance > 0)) return m;
  double window = 0;
  for (std::size_t lag = 1; lag < n / 2; ++lag) {
    m.correlation_time += covariance(lag) / variance;
    window = static_cast<double>(lag);
    if (window >= 5 * m.correlation_time) break;
  }
  m.correlation_time = std::max(m.correlation_time * (1 + (2 * window + 1) / static_cast<double>(n)), 0.5);
  m.standard_error = std::sqrt(2 * m.correlation_time * variance / static_cast<double>(n));
  return m;
}

Steadiness steadiness(std::span<const double> x, double tolerance) {
  Steadiness s;
  const std::size_t half = x.size() / 2;
  if (half < 4) return s;
  // Noise is what is left without the trend: a drift must not hide behind the correlation that it makes itself.
  const std::size_t n = 2 * half;
  const double middle = 0.5 * static_cast<double>(n - 1);
  double slope = 0, spread = 0, low = 0, high = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double from_middle = static_cast<double>(k) - middle;
    slope += from_middle * x[k];
    spread += from_middle * from_middle;
    (k < half ? low : high) += x[k] / static_cast<double>(half);
  }
  slope /= spread;
  std::vector<double> noise(n);
  for (std::size_t k = 0; k < n; ++k) noise[k] = x[k] - slope * (static_cast<double>(k) - middle);
  const std::span<const double> all(noise);
  s.drift = high - low;
  const double error = std::hypot(correlated_mean(all.first(half)).standard_error, correlated_mean(all.subspan(half)).standard_error);
  s.standard_errors = error > 0 ? std::abs(s.drift) / error : std::abs(s.drift) > 0 ? std::numeric_limits<double>::infinity() : 0;
  s.steady = s.standard_errors < 3 || std::abs(s.drift) < tolerance * std::abs(0.5 * (low + high));
  return s;
}

}  // namespace millscope::run
