#include "studies/challenge/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <tuple>

namespace millscope::challenge {
namespace {

constexpr std::size_t kFewForALine = 3, kFewForItsInterval = 6;
constexpr int kDraws = 4000;
constexpr double kPowerThatTells = 0.8;

/// NaN of NaN.
double normal_quantile(double p) { return std::isnan(p) ? p : boost::math::quantile(boost::math::normal_distribution<>(), p); }

/// Slope and intercept alone; nothing where all x are one.
std::optional<std::pair<double, double>> least_squares(const std::vector<std::pair<double, double>>& points) {
  constexpr double kSame = 1e-12;
  const auto n = static_cast<double>(points.size());
  double x = 0, y = 0, scale = 0, xx = 0, xy = 0;
  for (const auto& [a, b] : points) x += a / n, y += b / n, scale += a * a;
  for (const auto& [a, b] : points) xx += (a - x) * (a - x), xy += (a - x) * (b - y);
  if (!(xx > kSame * scale)) return std::nullopt;
  return std::pair{xy / xx, y - xy / xx * x};
}

/// p of a one-sided distance between n numbers and the even distribution.
double kolmogorov_p(double distance, double n) {
  const double scaled = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  return std::exp(-2 * scaled * scaled);
}

/// Element i of n evenly drawn ones; a standard engine with our own reduction, so that every library draws the same.
std::size_t drawn(std::mt19937_64& random, std::size_t n) { return random() % n; }

}  // namespace

double upper_bound(const Count& c, double confidence) {
  if (c.hits >= c.of) return 1;
  return boost::math::quantile(boost::math::beta_distribution<>(c.hits + 1, c.of - c.hits), confidence);
}

double lower_bound(const Count& c, double confidence) {
  if (c.hits == 0) return 0;
  return boost::math::quantile(boost::math::beta_distribution<>(c.hits, c.of - c.hits + 1), 1 - confidence);
}

double binomial_p(const Count& c, double share) {
  const boost::math::binomial_distribution<> counts(c.of, share);
  const double here = boost::math::pdf(counts, c.hits) * (1 + 1e-9);  // counts that are as likely differ in the last bits
  double p = 0;
  for (int k = 0; k <= c.of; ++k) {
    const double likely = boost::math::pdf(counts, k);
    if (likely <= here) p += likely;
  }
  return std::min(1.0, p);
}

double low_p(std::vector<double> numbers) {
  if (numbers.empty()) return 1;
  std::sort(numbers.begin(), numbers.end());
  const auto n = static_cast<double>(numbers.size());
  double distance = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) distance = std::max(distance, static_cast<double>(i + 1) / n - numbers[i]);
  return kolmogorov_p(distance, n);
}

double high_p(std::vector<double> numbers) {
  for (double& number : numbers) number = 1 - number;
  return low_p(std::move(numbers));
}

double ideal_power(double lambda, double level) {
  const double distance = std::sqrt(lambda) - normal_quantile(1 - level);
  return std::isnan(distance) ? distance : boost::math::cdf(boost::math::normal_distribution<>(), distance);
}

double telling_lambda(double level) {
  const double root = normal_quantile(1 - level) + normal_quantile(kPowerThatTells);
  return root * root;
}

Line line_through(const std::vector<std::pair<double, double>>& points) {
  Line line;
  line.points = points.size();
  if (points.size() < kFewForALine) return line;
  const auto through = least_squares(points);
  if (!through) return line;
  std::tie(line.slope, line.intercept) = *through;
  if (points.size() < kFewForItsInterval) return line;
  std::mt19937_64 random(1);
  std::vector<double> slopes;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<std::pair<double, double>> again;
    for (std::size_t i = 0; i < points.size(); ++i) again.push_back(points[drawn(random, points.size())]);
    if (const auto one = least_squares(again)) slopes.push_back(one->first);
  }
  if (slopes.size() < kDraws - kDraws / 100) return line;  // too many draws of one x
  std::sort(slopes.begin(), slopes.end());
  line.slope_low = slopes[slopes.size() / 40];
  line.slope_high = slopes[slopes.size() - 1 - slopes.size() / 40];
  return line;
}

}  // namespace millscope::challenge
