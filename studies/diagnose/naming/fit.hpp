// Parameters that explain observations best, with none, one or two candidates switched on.
//
//   Q(u, s) = (y − m(u, s))ᵀ Σ⁻¹ (y − m(u, s)) − tr(Σ⁻¹ S) (h(u, s) − h(u, 0)) + Σ ((θ_n − prior)/σ_n)² over the nuisances
//
// S is the covariance of one run about the surrogate and h its leverage: the second term is what the chance of the bank's runs adds to the
// first on average where candidates are on. Without it a strength is drawn towards nothing, as every slope is whose abscissae have errors
// (regression dilution; corrected as in Fuller 1987, Measurement Error Models, ch. 2). The less of a slope is sure, below
// three tenths of its square, the less is corrected: where chance may have made all of it a correction would fit chance with more of it.
// Nothing is corrected where there are fewer observables than coefficients: they do not tell slopes apart.
//
// u stays within the bank's ranges, a one-sided strength within 0 … 1. y enters through factors of the whitened coefficients, so that a
// fit costs the number of coefficients, not of observables.
#pragma once

#include <Eigen/QR>
#include <optional>
#include <vector>

#include "studies/diagnose/naming/surrogate.hpp"

namespace millscope::naming {

/// What a difference between observations and surrogate is measured with.
struct Weighting {
  /// `recording`: its covariance, here as if it were `longer` times as long; what the surrogate is wrong by stays.
  Weighting(const MatrixXd& recording, const Surrogate& surrogate, double longer = 1);

  MatrixXd run;         ///< S
  MatrixXd covariance;  ///< Σ: recording and surrogate
  MatrixXd whitener;    ///< W = L⁻¹ with Σ = L Lᵀ
  double run_noise;     ///< tr(Σ⁻¹ S)
};

struct FitResult {
  VectorXd coded;                 ///< θ
  std::vector<double> strengths;  ///< of the active candidates
  double q = 0;
};

/// Limits of a candidate's strength.
struct StrengthRange {
  double low = 0, high = 1;
};

/// Whether a fitted value stands at an end of its range (not at 0, where a candidate vanishes).
inline bool at_limit(double value, const StrengthRange& range) {
  constexpr double kSlack = 1e-3;  // of the half range 1 of a coded parameter
  if (range.low == range.high) return false;
  return (range.high != 0 && value >= range.high - kSlack) || (range.low != 0 && value <= range.low + kSlack);
}

/// What a model may do besides turning θ within its priors.
struct Switched {
  std::vector<Index> on = {};              ///< candidates
  std::vector<StrengthRange> ranges = {};  ///< of all candidates
  std::optional<Index> freed = {};         ///< a nuisance whose prior does not count
  bool exact = false;                      ///< fitted to data without noise: the bank's chance adds nothing that would have to be taken off
};

/// Surrogate and weighting must outlive it.
class Model {
 public:
  Model(const BankData& data, const Surrogate& surrogate, const Weighting& weighting, const Switched& switched);
  Model(const BankData&, const Surrogate&, Weighting&&, const Switched&) = delete;
  Model(const BankData&, Surrogate&&, const Weighting&, const Switched&) = delete;

  /// The same on a bank that has turned out other: its coefficients times W, observables × all features.
  Model with(const MatrixXd& whitened) const;
  FitResult fit(const VectorXd& observed) const { return fit_within({low_, high_}, observed); }
  /// The same with one of θ and the strengths, in that order, held at a value within its limits.
  FitResult fit_holding(Index coordinate, double value, const VectorXd& observed) const;
  double low(Index coordinate) const { return low_[coordinate]; }
  double high(Index coordinate) const { return high_[coordinate]; }
  std::vector<ActiveCandidate> active(const FitResult& fit) const;

 private:
  struct Limits {
    VectorXd low, high;
  };
  struct Work;
  void list_products();
  void use(const MatrixXd& whitened);
  MatrixXd chance_of_slopes(double ridge) const;
  void correct();
  VectorXd target(const VectorXd& white) const;
  void residual(const VectorXd& t, Work& work, VectorXd& out) const;
  void jacobian(const VectorXd& t, Work& work) const;
  double descend(const Limits& limits, VectorXd& t, Work& work) const;
  MatrixXd starts(const Limits& limits) const;
  FitResult fit_within(const Limits& limits, const VectorXd& observed) const;

  const Surrogate* surrogate_;
  const Weighting* weighting_;
  Eigen::HouseholderQR<MatrixXd> qr_;  ///< of W Bᵀ
  MatrixXd r_;                         ///< its R, or R' where the bank's chance is taken off
  bool corrected_ = false;
  std::vector<Index> active_;
  std::vector<Index> columns_;     ///< of all features those that are in use
  std::vector<Product> products_;  ///< the same, their factors counted 1, θ, strengths of `active_`, squares of these
  bool exact_ = false;
  VectorXd low_, high_, prior_, weight_;  ///< of (u, s); weight 1/σ in coded units, 0: flat
  Index theta_ = 0;
};

}  // namespace millscope::naming
