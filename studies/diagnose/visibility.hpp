// Whether data can show an effect at all: its part that no readjustment of θ can imitate.
//
//   s = m(θ̂, full strength) − m(θ̂, none),  s⊥: what is left of it after least squares on ∂m/∂θ with the nuisances' priors
//   λ = s⊥ᵀ Σ⁻¹ s⊥ − ε,  κ = √(λ / (sᵀ Σ⁻¹ s − ε)):  0 is fully concealed
//
// ε = h tr(W S Wᵀ) (n − d)/n is what the surrogate's own noise adds to s⊥ on average: h the leverage of the effect, S one run's covariance.
#pragma once

#include "studies/diagnose/naming.hpp"

namespace millscope::diagnose {

class Visibility {
 public:
  Visibility(const Problem& problem, const Surrogate& surrogate, const MatrixXd& whitening, const VectorXd& coded, int rival);

  double lambda() const { return lambda_; }  ///< at full strength, the better visible end of a two-sided range
  double kappa() const { return kappa_; }
  /// λ at a share (of a freed nuisance: at its coded value).
  double orthogonal(double share) const;

 private:
  VectorXd effect(double share) const;
  VectorXd rest(const VectorXd& s) const;
  double noise(double share) const;

  const Problem& problem_;
  const Surrogate& surrogate_;
  const MatrixXd& whitening_;
  VectorXd coded_;
  const Rival& rival_;
  MatrixXd tangent_;
  double run_noise_ = 0;  ///< tr(W S Wᵀ) (n − d)/n
  double lambda_ = 0, kappa_ = 0;
};

}  // namespace millscope::diagnose
