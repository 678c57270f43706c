// The statistics of the score, each by its source.
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace millscope::challenge {

struct Count {
  int hits = 0, of = 0;
  void add(bool hit) { hits += hit ? 1 : 0, ++of; }
  void operator+=(const Count& other) { hits += other.hits, of += other.of; }
  double share() const { return of > 0 ? static_cast<double>(hits) / of : std::numeric_limits<double>::quiet_NaN(); }
};

/// Clopper & Pearson 1934: the probability below which `of` trials give more than `hits` with the given confidence, and the one above which
/// they give fewer. One-sided; 0/59 has an upper bound of 5 % at 95 %.
double upper_bound(const Count& count, double confidence);
double lower_bound(const Count& count, double confidence);

/// That a count is at most as likely as this one, if each trial hits with the probability `share`: the exact binomial test, two-sided.
double binomial_p(const Count& count, double share);

/// Kolmogorov's test, one-sided (Smirnov 1944, in the approximation of Stephens 1970): that numbers which lie evenly in [0, 1], or higher,
/// come out as low by chance; and as high if they lie evenly or lower. 1 for none.
double low_p(std::vector<double> numbers);
double high_p(std::vector<double> numbers);

/// Of a test of one one-sided strength at `level` (of several together: Bonferroni's share of it), if the noise is normal and known:
/// Φ(√λ − z).
double ideal_power(double lambda, double level);
/// The λ at which the ideal power is 80 %.
double telling_lambda(double level);

/// y = intercept + slope · x, least squares.
struct Line {
  std::size_t points = 0;
  double slope = std::numeric_limits<double>::quiet_NaN(), intercept = std::numeric_limits<double>::quiet_NaN();
  double slope_low = std::numeric_limits<double>::quiet_NaN(), slope_high = std::numeric_limits<double>::quiet_NaN();  ///< 95 %
};
/// The interval is that of the pairs (x, y) drawn anew (Efron 1979): the scatter may differ from point to point, but the points have to be
/// independent. NaN below 3 points, or where all have one x; the interval below 6, or where draws have one x.
Line line_through(const std::vector<std::pair<double, double>>& points);

}  // namespace millscope::challenge
