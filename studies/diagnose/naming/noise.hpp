// Errors of observations, drawn.
#pragma once

#include <vector>

#include "kernel/base/random.hpp"
#include "studies/diagnose/naming/bank_data.hpp"

namespace millscope::naming {

/// Observables whose errors are known beside one another, but their common size from few values only: with so many degrees of freedom.
struct CommonSize {
  std::vector<Index> observables;
  double degrees = 0;
};

/// What a variance of ν degrees of freedom comes out as, in parts of itself, at a standard normal quantile (Wilson & Hilferty 1931).
double variance_at(double degrees, double normal);

class Noise {
 public:
  Noise() = default;
  /// Throws base::UserError when the covariance is not positive definite.
  Noise(const MatrixXd& covariance, std::vector<CommonSize> sizes);
  /// Normal; where a size is known from ν degrees of freedom times √(ν/χ²), as a measured size errs (Student's t of many numbers).
  VectorXd draw(base::RandomStream& random) const;

 private:
  MatrixXd factor_;
  std::vector<CommonSize> sizes_;
};

}  // namespace millscope::naming
