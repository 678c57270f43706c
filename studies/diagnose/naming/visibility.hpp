// Whether data can show a candidate at all: how far its noise-free data stay from the base, however that is retuned.
//
//   λ(φ) = min over u of [(m(θ, φ) − m(u))ᵀ Σ⁻¹ (m(θ, φ) − m(u)) + P(u)] − ε,  κ = √(λ / (sᵀ Σ⁻¹ s − ε)):  0 is fully concealed
//   s = m(θ, full strength) − m(θ, none),  P: the nuisances' priors, about θ
//
// The base is refitted in earnest: where retuning moves it far, its own curvature imitates more than its slope at θ would. At the fitted θ
// and strength λ is what ΔQ is on average.
//
// ε = h tr M (n − d)/n is what the surrogate's own noise adds on average: h the leverage of the candidate, M = W S Wᵀ one run's covariance
// in noise units. With s⊥ = m(θ, φ) − m(u) it makes λ uncertain by σ² = a + b λ, a = 2 h² tr M² (1 + 1/ν) and b = 4 h s⊥ᵀ M s⊥/s⊥ᵀ s⊥ with
// the ν degrees of freedom behind S: few runs cannot tell a small λ from none. What the surrogate has no columns for is not in it.
#pragma once

#include <utility>

#include "studies/diagnose/naming/naming.hpp"

namespace millscope::naming {

class Visibility {
 public:
  /// A model about which something is looked for: the coded θ, best that which was fitted with it, and what is on besides and is refitted.
  struct About {
    VectorXd coded;
    std::vector<ActiveCandidate> beside = {};
  };
  Visibility(const Problem& problem, const Surrogate& surrogate, const Weighting& weighting, const About& about, Index alternative);
  Visibility(const Problem&, Surrogate&&, const Weighting&, const About&, Index) = delete;
  Visibility(const Problem&, const Surrogate&, Weighting&&, const About&, Index) = delete;

  /// Where it shows best in its range: at full strength, unless parameters imitate more of it there or few runs make it seem so.
  double lambda() const { return lambda_; }
  double kappa() const { return kappa_; }
  /// λ is below it with 95 %, wherever it shows best: that whose estimate would be as low as this in one of twenty banks, λ + z²b/2 + z √(a
  /// + b λ + z²b²/4).
  double lambda_high() const;
  /// λ at a strength (of a freed nuisance: at its coded value).
  double at(double strength) const;
  /// (strength, λ) over its range, its ends among them, and zero for a candidate.
  const std::vector<std::pair<double, double>>& curve() const { return curve_; }

 private:
  struct Rest {
    VectorXd white;     ///< W (m(θ, φ) − m(u))
    double square = 0;  ///< with the priors, without ε
  };
  Rest rest(double strength) const;
  VectorXd observed(double strength) const;
  double leverage(double strength) const;
  double noise(double strength) const;
  double high(double strength) const;
  double none() const;  ///< strength at which there is nothing
  StrengthRange range() const;
  std::vector<double> strengths() const;  ///< over the range, its ends among them; of a nuisance these alone

  const Problem& problem_;
  const Surrogate& surrogate_;
  const Weighting& weighting_;
  VectorXd coded_;
  std::vector<ActiveCandidate> beside_;
  const Alternative& alternative_;
  Model base_;
  MatrixXd run_covariance_;  ///< M
  double run_noise_ = 0;     ///< tr M (n − d)/n
  std::vector<std::pair<double, double>> curve_;
  double lambda_ = 0, kappa_ = 0;
};

}  // namespace millscope::naming
