// Which of many differences are real: one error rate for all of them together.
//
//   d_k = b_k − a_k,  s_k² = s_ak² + s_bk²,  t_k = d_k / s_k          element k of an observable: a number, a bin, a cell, a region
//   z_k : the normal deviate with the two-sided p-value of t_k at ν_k degrees of freedom
//   z*_rk = (b*_rk − a*_rk) / s_k                                     joint resample r, centred: what chance alone does
//   w_k = min(1, 2.576 / 99 % point of |z*_rk|)                       heavy tails weigh down their own element, not all the others
//   M = max_k w_k |z_k|,  M*_r = max_k w_k |z*_rk|                    of one observable
//   p = (1 + #{M*_r ≥ M}) / (1 + R)                                   max-T within the observable
//   adjusted p: step-down min-P over all observables                  Westfall and Young, Resampling-Based Multiple Testing (1993), 2.8
//
// A single number: ν_k of Welch and Satterthwaite. Where many elements are judged at once some have, by chance, too small an error of
// their own (a rare visit that did not come), and the largest |t| would pick just those. So an observable of many elements takes
//
//   φ: mean ratio of s_bk² to s_ak² over its elements,   u_k = (ν_a s_ak² + ν_b s_bk²/φ)/(ν_a + ν_b)
//   s_ak² at least u_k,  s_bk² at least φ u_k,  ν_k = ν_a + ν_b
//
// The error rate stays at or below 5 % for skewed values and unequal numbers of blocks (tests/compare); without it, it is 70 % for 60
// and 12. One observable counts as much as another, a map of a thousand cells as much as the power.
#pragma once

#include <cstddef>
#include <vector>

namespace millscope::compare {

inline constexpr std::size_t kMany = 8;  ///< elements from which on errors are held against each other

/// Elements of one observable that can be judged. Draws are draw-major [draws, elements]: resampled value − value, NaN: undefined.
struct TestedObservable {
  std::vector<double> difference;  ///< d_k
  std::vector<double> error_a, error_b;
  std::vector<double> blocks_a, blocks_b;  ///< effective blocks of each element, > 1
  std::vector<float> draws_a, draws_b;
  std::size_t size() const { return difference.size(); }
};

struct TestedElement {
  double error_a = 0, error_b = 0;
  double error = 0;          ///< s_k
  double low = 0, high = 0;  ///< interval of d_k for this element alone
  double deviate = 0;        ///< |z_k|
  double weight = 1;         ///< w_k
  double p = 1;              ///< within its observable
  double adjusted_p = 1;     ///< over everything
};

struct ObservableVerdict {
  std::vector<TestedElement> elements;
  std::size_t strongest = 0;  ///< the element with the largest w_k |z_k|
  double p = 1;               ///< of the observable alone
  double adjusted_p = 1;      ///< family-wise
};

inline constexpr std::size_t kResamplePairs = 20000;

/// Judges all observables together; each must have at least one element with an error above 0, and all the same numbers of draws.
/// `confidence`: of the intervals. Draw r of A goes with draw r + shift of B for several shifts, so that equal seeds do not pair equal
/// blocks; `pairs` in all: adjusted p-values are no smaller than about the number of observables over `pairs`.
std::vector<ObservableVerdict> judge(const std::vector<TestedObservable>& observables, double confidence,
                                     std::size_t pairs = kResamplePairs);

/// Degrees of freedom of the difference of two means whose errors rest on n_a and n_b blocks (Welch and Satterthwaite).
double degrees_of_freedom(double error_a, double blocks_a, double error_b, double blocks_b);

/// The normal deviate that is as improbable, on both sides together, as `t` at `freedom` degrees of freedom.
double normal_deviate(double t, double freedom);

}  // namespace millscope::compare
