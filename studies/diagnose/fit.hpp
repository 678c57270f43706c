// Parameters that explain observations best, with none, one or two candidates switched on.
//
//   Q(u, s) = (y − m(u, s))ᵀ Σ⁻¹ (y − m(u, s)) + Σ ((θ_n − prior)/σ_n)² over the nuisances
//
// u stays within the bank's ranges, a one-sided share within 0 … 1. y enters through QR factors of the whitened coefficients, so that a
// fit costs the number of coefficients, not of observables.
#pragma once

#include <memory>
#include <vector>

#include "studies/diagnose/surrogate.hpp"

namespace millscope::diagnose {

/// Lower triangular L⁻¹ with Σ = L Lᵀ. Throws config::UserError when Σ is not positive definite.
MatrixXd whitener(const MatrixXd& covariance);
/// L itself.
MatrixXd factor(const MatrixXd& covariance);

struct FitResult {
  VectorXd coded;              ///< θ
  std::vector<double> shares;  ///< of the active candidates
  double q = 0;
};

/// Limits of a candidate's share.
struct ShareRange {
  double low = 0, high = 1;
};

class Model {
 public:
  /// `active`: candidates that are switched on. `freed`: a nuisance whose prior does not count; −1: none.
  Model(const BankData& data, const Surrogate& surrogate, const MatrixXd& whitener, std::vector<int> active,
        const std::vector<ShareRange>& ranges, Index freed = -1);

  FitResult fit(const VectorXd& observed) const;
  /// The same with one of θ and the shares, in that order, held at a value within its limits.
  FitResult fit_holding(Index coordinate, double value, const VectorXd& observed) const;
  double low(Index coordinate) const { return low_[coordinate]; }
  double high(Index coordinate) const { return high_[coordinate]; }
  const std::vector<int>& active() const { return active_; }
  std::vector<Effect> effects(const FitResult& fit) const;

 private:
  struct Target {
    VectorXd z;         ///< Qᵀ W y
    double beyond = 0;  ///< what no coefficients reach
  };
  VectorXd features(const VectorXd& t) const;
  VectorXd residual(const VectorXd& t, const Target& target) const;
  MatrixXd jacobian(const VectorXd& t) const;
  double descend(VectorXd& t, const Target& target) const;
  std::vector<VectorXd> starts() const;

  const Features* features_;
  MatrixXd whitener_, r_, qt_;
  std::vector<int> active_;
  VectorXd low_, high_, prior_, weight_;  ///< of (u, s); weight 1/σ in coded units, 0: flat
  Index theta_ = 0;
};

}  // namespace millscope::diagnose
