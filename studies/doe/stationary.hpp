// The stationary point of a quadratic surface. For the files of this room.
#pragma once

#include "studies/doe/doe.hpp"

namespace millscope::doe {

/// Terms of the full quadratic: {}, {i}, {i, i}, {i, j}.
std::vector<std::vector<int>> quadratic_terms(int factors);

/// Values of the terms at a coded point, and their derivatives with respect to each factor, [factors, terms].
Eigen::VectorXd terms_at(const std::vector<Coefficient>& coefficients, const Eigen::VectorXd& coded);
Eigen::MatrixXd slopes_at(const std::vector<Coefficient>& coefficients, const Eigen::VectorXd& coded);

/// value = c + linear·x + xᵀ form x.
struct Quadratic {
  Eigen::VectorXd linear;
  Eigen::MatrixXd form;
};
Quadratic quadratic_of(const Surface& surface);

/// Whether the gradient at a coded point cannot be told from zero: the point belongs to the confidence region (Box, Hunter 1954).
bool gradient_may_vanish(const Surface& surface, const Eigen::VectorXd& coded);

/// Where the gradient vanishes, what kind of point it is, and its confidence region; nothing where there is no curvature at all. Uses the
/// coefficients, their covariance, the residual's degrees of freedom and the box of the runs.
std::optional<StationaryPoint> find_stationary(const Surface& surface);

}  // namespace millscope::doe
