// 90 % intervals, p-values that hold together, and quantiles, each by the rule that its users need.
//
//   quantile               rank round(f (n − 1)), a half upwards: always one of the values; of two middle values the upper
//   quantile_below         rank ⌊f (n − 1)⌋: for a scale that no more than the rest may reach beyond
//   quantile_of_next       rank ⌈f (n + 1)⌉ − 1: what one more draw of the same law stays below with probability f at least
//   interpolated_quantile  between ranks (Hyndman & Fan 1996, type 7): smooth in the draws of a posterior
//   weighted_quantile      the first value up to which the part f of the weights lies
//
// Ranks count from 0 in the sorted values. Analyzers, which see the SDK alone, have that of a histogram (analyzers/charge_features).
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace millscope::base {

inline constexpr double kNormal90 = 1.6448536269514722;  ///< standard errors to either side that hold 90 % of a normal law

/// A value and its 90 % interval, in the unit that the holder states.
struct Interval90 {
  double value = 0, low = 0, high = 0;

  static Interval90 about(double value, double standard_error) {
    return {value, value - kNormal90 * standard_error, value + kNormal90 * standard_error};
  }
  bool known() const { return std::isfinite(low) && std::isfinite(high); }
  bool holds(double truth) const { return truth >= low && truth <= high; }
  double standard_error() const { return (high - low) / (2 * kNormal90); }  ///< of a normal law with this interval
};

/// The value of a rank; `values` is left in another order.
template <class Number>
Number value_of_rank(std::vector<Number>& values, std::size_t rank) {
  assert(rank < values.size());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// `values`: not empty, left in another order.
inline double quantile(std::vector<double>& values, double fraction) {
  return value_of_rank(values, std::llround(fraction * static_cast<double>(values.size() - 1)));
}

/// `values`: not empty, left in another order.
template <class Number>
Number quantile_below(std::vector<Number>& values, double fraction) {
  return value_of_rank(values, static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1)));
}

/// The largest where there are too few. `values`: not empty, left in another order.
inline double quantile_of_next(std::vector<double>& values, double fraction) {
  assert(!values.empty() && fraction > 0);
  const auto count = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size() + 1)));
  return value_of_rank(values, std::min(count, values.size()) - 1);
}

/// `sorted`: rising, not empty.
inline double interpolated_quantile(std::span<const double> sorted, double fraction) {
  assert(!sorted.empty());
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Holm 1979, step-down: p-values that hold for all together, however they hang together, in the order given. The k-th smallest times how
/// many are left, never falling, at most 1.
std::vector<double> holm(const std::vector<double>& p);

/// NaN where nothing has a weight.
double weighted_quantile(std::vector<std::pair<double, double>> value_and_weight, double fraction);

}  // namespace millscope::base
