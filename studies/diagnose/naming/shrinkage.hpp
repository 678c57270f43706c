// A covariance from few draws.
#pragma once

#include <Eigen/Core>

namespace millscope::naming {

/// Of the columns of `draws` [draws, values].
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& draws);

/// A covariance from so many blocks with its correlations shrunk towards none by λ = Σ Var(r)/Σ r² over the pairs, with
/// Var(r) ≈ (1 − r²)²/(blocks − 1) (Schäfer and Strimmer 2005): few blocks have correlations of chance.
Eigen::MatrixXd shrunk(Eigen::MatrixXd covariance, double blocks);

}  // namespace millscope::naming
