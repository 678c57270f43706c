// Whether data can show a candidate at all: how far its noise-free data stay from the base, however that is retuned.
//
//   λ(φ) = min over u of [(m(θ, φ) − m(u))ᵀ Σ⁻¹ (m(θ, φ) − m(u)) + P(u)] − ε,  κ(φ) = √(λ / (sᵀ Σ⁻¹ s − ε)):  0 is fully concealed
//   s = m(θ, φ) − m(θ, none),  P: the nuisances' priors, about θ
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

  /// λ and κ where it shows best in its range: at full strength, unless parameters imitate more of it there or few runs make it seem so.
  double lambda() const { return best().lambda; }
  double kappa() const;
  /// λ is below it with 95 %, wherever it shows best: that whose estimate would be as low as this in one of twenty banks, λ + z²b/2 + z √(a
  /// + b λ + z²b²/4).
  double lambda_high() const;
  /// λ at a strength (of a freed nuisance: at its coded value).
  double at(double strength) const;
  /// (strength, λ) over its range, its ends among them, and zero for a candidate.
  std::vector<std::pair<double, double>> curve() const;

 private:
  struct Seen {
    double strength = 0;
    VectorXd white;  ///< W (m(θ, φ) − m(u))
    double lambda = 0;
    double h = 0;  ///< leverage
  };
  Seen look(double strength) const;
  const Seen& best() const;
  VectorXd observed(double strength) const;
  double leverage(double strength) const;
  double high(const Seen& seen) const;
  double none() const;                    ///< strength at which there is nothing
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
  std::vector<Seen> seen_;   ///< over the range, rising
};

}  // namespace millscope::naming
