// Whether data can show an effect at all: its part that no readjustment of θ can imitate.
//
//   s = m(θ̂, full strength) − m(θ̂, none),  s⊥: what is left of it after least squares on ∂m/∂θ with the nuisances' priors
//   λ = s⊥ᵀ Σ⁻¹ s⊥ − ε,  κ = √(λ / (sᵀ Σ⁻¹ s − ε)):  0 is fully concealed
//
// ε = h tr M (n − d)/n is what the surrogate's own noise adds on average: h the leverage of the effect, M = W S Wᵀ one run's covariance in
// noise units. It makes λ uncertain by σ² = a + b λ, a = 2 h² tr M² (1 + 1/ν) and b = 4 h s⊥ᵀ M s⊥/s⊥ᵀ s⊥ with the ν degrees of freedom
// behind S: few runs cannot tell a small λ from none. What the surrogate has no columns for is not in it.
#pragma once

#include "studies/diagnose/naming.hpp"

namespace millscope::diagnose {

class Visibility {
 public:
  Visibility(const Problem& problem, const Surrogate& surrogate, const MatrixXd& whitening, const VectorXd& coded, int rival);

  double lambda() const { return lambda_; }  ///< at full strength, the better visible end of a two-sided range
  double kappa() const { return kappa_; }
  /// λ is below it with 95 %: that whose estimate would be as low as this in one of twenty banks, λ + z²b/2 + z √(a + b λ + z²b²/4).
  double lambda_high() const;
  /// λ at a share (of a freed nuisance: at its coded value).
  double orthogonal(double share) const;

 private:
  VectorXd effect(double share) const;
  VectorXd rest(const VectorXd& s) const;
  double noise(double share) const;
  double high(double share) const;
  std::vector<double> ends() const;  ///< of the range: full strength, and the other one of a two-sided range

  const Problem& problem_;
  const Surrogate& surrogate_;
  const MatrixXd& whitening_;
  VectorXd coded_;
  const Rival& rival_;
  MatrixXd tangent_;
  MatrixXd run_covariance_;  ///< M
  double run_noise_ = 0;     ///< tr M (n − d)/n
  double lambda_ = 0, kappa_ = 0;
};

}  // namespace millscope::diagnose
