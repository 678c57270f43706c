// Maximum likelihood with errors that hold also where the model is not quite the truth.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace millscope::camera {

/// One parameter of a likelihood.
struct FitParameter {
  double start, low, high;
  double prior = 0;                                            ///< what is known beforehand, and
  double deviation = std::numeric_limits<double>::infinity();  ///< how well; infinite: nothing is
};

struct Fit {
  std::vector<double> value;
  std::vector<std::vector<double>> covariance;
  double log_likelihood = 0;
  double error(std::size_t i) const;  ///< standard error; infinite where the data do not determine the parameter
};

/// Log-likelihoods of independent groups of data at a point; the groups' number and order never change.
using LogLikelihood = std::function<std::vector<double>(const std::vector<double>&)>;

/// Maximises the sum over groups, and what is known beforehand, with NLopt's BOBYQA, then H⁻¹ G H⁻¹ with H the curvature of the sum and G =
/// Σ g gᵀ over the groups' gradients (Huber 1967; White 1982). Parameters should be of order one (logarithms, scaled numbers).
Fit maximise(const LogLikelihood& groups, const std::vector<FitParameter>& parameters);
/// The same without the errors, which cost half as much again: `covariance` is empty.
Fit likeliest(const LogLikelihood& groups, const std::vector<FitParameter>& parameters);

}  // namespace millscope::camera
