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
  double share() const { return of > 0 ? static_cast<double>(hits) / of : std::numeric_limits<double>::quiet_NaN(); }
};

/// Clopper & Pearson 1934: the probability below which `of` trials give more than `hits` with the given confidence, and the one above which
/// they give fewer. One-sided; 0/59 has an upper bound of 5 % at 95 %.
double upper_bound(const Count& count, double confidence);
double lower_bound(const Count& count, double confidence);

/// That a count is at most as likely as this one, if each trial hits with the probability `share`: the exact binomial test, two-sided.
double binomial_p(const Count& count, double share);

/// Holm 1979: p-values that hold for all of them together, in the order given.
std::vector<double> holm(const std::vector<double>& p);

/// Kolmogorov 1933, in the approximation of Stephens 1970: that numbers in [0, 1] lie as unevenly by chance. 1 for none.
double uniform_p(std::vector<double> numbers);

/// Of a test of `alternatives` one-sided strengths at a level for all together (Bonferroni), if the noise is normal and known and the other
/// alternatives never win: Φ(√λ − z). What no method can do much better.
double ideal_power(double lambda, double level, std::size_t alternatives);
/// The λ at which the ideal power is 80 %.
double telling_lambda(double level, std::size_t alternatives);

/// y = intercept + slope · x, least squares.
struct Line {
  double slope = std::numeric_limits<double>::quiet_NaN(), intercept = std::numeric_limits<double>::quiet_NaN();
  double slope_low = std::numeric_limits<double>::quiet_NaN(), slope_high = std::numeric_limits<double>::quiet_NaN();  ///< 95 %
};
/// The interval is that of the pairs (x, y) drawn anew (Efron 1979), which asks nothing of the scatter. NaN below 3 points; the interval
/// below 6.
Line line_through(const std::vector<std::pair<double, double>>& points);

}  // namespace millscope::challenge
