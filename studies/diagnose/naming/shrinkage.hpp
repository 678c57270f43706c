// A covariance from few draws.
#pragma once

#include <Eigen/Core>

namespace millscope::naming {

/// Covariance of the columns of `draws` [draws, values], correlations shrunk towards none by λ = Σ Var(r)/Σ r² over the pairs, with
/// Var(r) ≈ (1 − r²)²/(blocks − 1) (Schäfer and Strimmer 2005): draws from few blocks have correlations of chance.
Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& draws, double blocks);

}  // namespace millscope::naming
