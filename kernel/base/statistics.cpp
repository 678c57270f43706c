#include "kernel/base/statistics.hpp"

#include <limits>
#include <numeric>

namespace millscope::base {

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> out(p.size());
  double largest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - k) * p[order[k]]));
    out[order[k]] = largest;
  }
  return out;
}

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
