// Covariances: from few draws, and their factors.
#pragma once

#include <Eigen/Core>

namespace millscope::naming {

/// Of the columns of `draws` [draws, values].
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& draws);

/// A covariance from so many blocks with its correlations shrunk towards none by λ = Σ Var(r)/Σ r² over the pairs, with
/// Var(r) ≈ (1 − r²)²/(blocks − 1) (Schäfer and Strimmer 2005): few blocks have correlations of chance.
Eigen::MatrixXd shrunk(Eigen::MatrixXd covariance, double blocks);

/// Lower triangular L with Σ = L Lᵀ. Throws base::UserError when Σ is not positive definite.
Eigen::MatrixXd factor(const Eigen::MatrixXd& covariance);
/// L⁻¹.
Eigen::MatrixXd whitener(const Eigen::MatrixXd& covariance);

}  // namespace millscope::naming
