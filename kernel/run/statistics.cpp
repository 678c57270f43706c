#include "kernel/run/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
  for (std::size_t lag = 1; lag < n / 2; ++lag) {
    m.correlation_time += covariance(lag) / variance;
    if (static_cast<double>(lag) >= 5 * m.correlation_time) break;
  }
  m.correlation_time = std::max(m.correlation_time, 0.5);
  m.standard_error = std::sqrt(2 * m.correlation_time * variance / static_cast<double>(n));
  return m;
}

Steadiness steadiness(std::span<const double> x, double tolerance) {
  Steadiness s;
  const std::size_t half = x.size() / 2;
  if (half < 4) return s;
  const Mean first = correlated_mean(x.first(half)), second = correlated_mean(x.subspan(half));
  s.drift = second.value - first.value;
  const double error = std::hypot(first.standard_error, second.standard_error);
  s.standard_errors = error > 0 ? std::abs(s.drift) / error : std::abs(s.drift) > 0 ? std::numeric_limits<double>::infinity() : 0;
  s.steady = s.standard_errors < 3 || std::abs(s.drift) < tolerance * std::abs(0.5 * (first.value + second.value));
  return s;
}

}  // namespace millscope::run
