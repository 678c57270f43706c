#include "studies/inspect/resample.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "millscope/random.hpp"

namespace millscope::inspect {

std::vector<double> bootstrap_deviation(std::size_t groups, std::size_t draws,
                                        const std::function<std::vector<double>(const std::vector<double>&)>& estimate) {
  Random random(20150601);
  std::vector<double> sum, squares, times(groups);
  double count = 0;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    std::fill(times.begin(), times.end(), 0.0);
    for (std::size_t g = 0; g < groups; ++g) times[random.below(groups)] += 1;
    const std::vector<double> values = estimate(times);
    if (values.empty()) continue;
    if (count == 0) sum = squares = std::vector<double>(values.size());
    count += 1;
    for (std::size_t i = 0; i < values.size(); ++i) {  // Welford
      const double before = values[i] - sum[i];
      sum[i] += before / count;
      squares[i] += before * (values[i] - sum[i]);
    }
  }
  if (count < 2) return {};
  for (double& s : squares) s = std::sqrt(s / (count - 1));
  return squares;
}

base::Interval90 interval(double value, double deviation, double freedom, double floor) {
  const boost::math::students_t distribution(std::max(1.0, freedom));
  const double half = std::hypot(boost::math::quantile(distribution, 0.95) * deviation, floor);
  return {value, value - half, value + half};
}

base::Interval90 proportion(double successes, double trials) {
  constexpr double z = base::kNormal90;
  const double p = successes / trials, denominator = 1 + z * z / trials;
  const double centre = (p + z * z / (2 * trials)) / denominator;
  const double half = z * std::sqrt(p * (1 - p) / trials + z * z / (4 * trials * trials)) / denominator;
  return {p, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace millscope::inspect
