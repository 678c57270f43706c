#include "kernel/base/statistics.hpp"

#include <limits>

namespace millscope::base {

double weighted_quantile(std::vector<std::pair<double, double>> value_and_weight, double fraction) {
  std::sort(value_and_weight.begin(), value_and_weight.end());
  double all = 0, below = 0;
  for (const auto& [value, weight] : value_and_weight) all += weight;
  for (const auto& [value, weight] : value_and_weight) {
    below += weight;
    if (weight > 0 && below >= fraction * all) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace millscope::base
