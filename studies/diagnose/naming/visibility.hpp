// Whether data can show an effect at all: how far its noise-free data stay from the base, however that is retuned.
//
//   λ(φ) = min over u of [(m(θ, φ) − m(u))ᵀ Σ⁻¹ (m(θ, φ) − m(u)) + P(u)] − ε,  κ = √(λ / (sᵀ Σ⁻¹ s − ε)):  0 is fully concealed
//   s = m(θ, full strength) − m(θ, none),  P: the nuisances' priors, about θ
//
// The base is refitted in earnest: where retuning moves it far, its own curvature imitates more than its slope at θ would. At the fitted θ
// and strength λ is what ΔQ is on average.
//
// ε = h tr M (n − d)/n is what the surrogate's own noise adds on average: h the leverage of the effect, M = W S Wᵀ one run's covariance in
// noise units. With s⊥ = m(θ, φ) − m(u) it makes λ uncertain by σ² = a + b λ, a = 2 h² tr M² (1 + 1/ν) and b = 4 h s⊥ᵀ M s⊥/s⊥ᵀ s⊥ with the
// ν degrees of freedom behind S: few runs cannot tell a small λ from none. What the surrogate has no columns for is not in it.
#pragma once

#include <utility>

#include "studies/diagnose/naming/naming.hpp"

namespace millscope::diagnose {

class Visibility {
 public:
  /// About the coded θ: best that which was fitted with the effect.
  Visibility(const Problem& problem, const Surrogate& surrogate, const Weighting& weighting, const VectorXd& coded, int rival);
  Visibility(const Problem&, Surrogate&&, const Weighting&, const VectorXd&, int) = delete;
  Visibility(const Problem&, const Surrogate&, Weighting&&, const VectorXd&, int) = delete;

  double lambda() const { return lambda_; }  ///< at full strength, the better visible end of a two-sided range
  double kappa() const { return kappa_; }
  /// λ is below it with 95 %: that whose estimate would be as low as this in one of twenty banks, λ + z²b/2 + z √(a + b λ + z²b²/4).
  double lambda_high() const;
  /// λ at a share (of a freed nuisance: at its coded value).
  double at(double share) const;
  /// (share, λ) over a candidate's range, its ends and zero among them; nothing for a nuisance.
  std::vector<std::pair<double, double>> curve() const;

 private:
  struct Rest {
    VectorXd white;     ///< W (m(θ, φ) − m(u))
    double square = 0;  ///< with the priors, without ε
  };
  Rest rest(double share) const;
  VectorXd observed(double share) const;
  double noise(double share) const;
  double high(double share) const;
  double none() const;               ///< share at which there is no effect
  std::vector<double> ends() const;  ///< of the range: full strength, and the other one of a two-sided range

  const Problem& problem_;
  const Surrogate& surrogate_;
  const Weighting& weighting_;
  VectorXd coded_;
  const Rival& rival_;
  Model base_;
  MatrixXd run_covariance_;  ///< M
  double run_noise_ = 0;     ///< tr M (n − d)/n
  double lambda_ = 0, kappa_ = 0;
};

}  // namespace millscope::diagnose
