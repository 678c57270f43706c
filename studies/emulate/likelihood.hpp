// How well parameters explain what was observed.
#pragma once

#include <Eigen/Cholesky>
#include <limits>

#include "studies/emulate/emulator.hpp"

namespace millscope::emulate {

inline constexpr double kNowhere = -std::numeric_limits<double>::infinity();  ///< logarithm of what cannot be

/// Throws base::UserError when the observed values are not finite or the covariance is none; std::invalid_argument for wrong sizes.
void check_observed(const Emulator& emulator, const Observed& observed);

class Likelihood {
 public:
  Likelihood(const Emulator& emulator, const Box& box, const Observed& observed);

  /// −½ r' C⁻¹ r − ½ log |C|; −infinity outside the box or where not allowed. `coded`: in [−1, 1].
  double log_density(const Eigen::VectorXd& coded) const;
  /// r' C⁻¹ r.
  double misfit(const Eigen::VectorXd& coded) const;
  /// ∂m/∂u in standard deviations: L⁻¹ ∂m/∂u with C = L L'; observables × parameters.
  Eigen::MatrixXd whitened_slopes(const Eigen::VectorXd& coded) const;
  const Box& box() const { return box_; }
  Eigen::Index observables() const { return observed_.value.size(); }

 private:
  struct At {
    Eigen::VectorXd residual;
    Eigen::LLT<Eigen::MatrixXd> root;
  };
  At at(const Eigen::VectorXd& coded) const;
  const Emulator& emulator_;
  const Box& box_;
  const Observed& observed_;
};

/// The most likely point, coded, from several starts.
Eigen::VectorXd find_mode(const Likelihood& likelihood, std::uint64_t seed);
/// The most likely point near another. `step`: fraction of the ranges.
Eigen::VectorXd climb(const Likelihood& likelihood, const Eigen::VectorXd& coded, double step, std::uint64_t seed);

}  // namespace millscope::emulate
