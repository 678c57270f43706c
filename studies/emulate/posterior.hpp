// What the data say of the parameters: their joint distribution, what is determined and what is concealed by what.
//
//   log p(θ) = −½ r' C⁻¹ r − ½ log |C| + const inside the box where allowed,   r = y − m(θ),   C = Σ_recording + V_emulator(θ)
#pragma once

#include <cstdint>

#include "studies/emulate/emulator.hpp"

namespace millscope::emulate {

struct SamplerOptions {
  std::uint64_t seed = 1;
  int chains = 0;     ///< per population, of two; 0: 2 parameters + 4
  int draws = 1000;   ///< per chain, after as many that are thrown away; doubled until the chains agree
  int doublings = 4;  ///< at most
  int threads = 1;    ///< the result does not depend on it
};

enum class Determined { well, weakly, hardly };

struct Marginal {
  double mean, deviation, median;
  double low90, high90, low50, high50;  ///< equal tails
  double mode;                          ///< of the joint distribution
  double width_ratio;                   ///< 90 % interval's width to the one before the data; 1: the data say nothing
  double conditional_ratio;             ///< the same if all other parameters were known
  double r_hat, effective_draws;        ///< split R̂ over chains; Gelman et al. 2013
  bool at_edge;                         ///< the mode lies at the end of its range
  Determined determined;                ///< well: width_ratio < 1/3; hardly: > 2/3
  std::string statement;                ///< one plain sentence with the number
};

struct Posterior {
  Eigen::MatrixXd samples;      ///< draws × parameters, natural units; chain after chain
  Eigen::VectorXd log_density;  ///< of each, up to a constant
  Eigen::VectorXd mode;
  Eigen::MatrixXd correlation;
  std::vector<Marginal> marginal;
  double misfit;              ///< r' C⁻¹ r at the mode
  double misfit_probability;  ///< of a larger one if the simulation can tell the truth; small: no parameters fit
  double acceptance;
  bool converged;                       ///< all R̂ < 1.05 and at least 400 effective draws
  std::vector<std::string> statements;  ///< on the whole: misfit, convergence, pairs that conceal each other
};

/// Throws base::UserError when nothing in the box is allowed, the observed values are not finite, or the covariance is no covariance.
Posterior sample_posterior(const Emulator& emulator, const Box& box, const Observed& observed, const SamplerOptions& options = {});

/// How the fit suffers when one parameter is held at a value.
struct Profile {
  Eigen::VectorXd value;       ///< grid over the parameter's range, natural units
  Eigen::VectorXd alone;       ///< log density above, others held at the mode; relative to the mode
  Eigen::VectorXd readjusted;  ///< others adjusted as well as they can; relative to the mode
  Eigen::MatrixXd others;      ///< grid × parameters: the adjusted point
  double low_alone, high_alone, low_readjusted,
      high_readjusted;            ///< where the log density has lost 1.35 (90 %); the range's end where it never does
  double sensitivity_alone;       ///< ‖s‖: shift of the observables, in their standard deviations, over half the range
  double sensitivity_readjusted;  ///< ‖s⊥‖: what of it no other parameter can imitate
  double concealed;               ///< 1 − ‖s⊥‖/‖s‖
};

Profile profile(const Emulator& emulator, const Box& box, const Observed& observed, int parameter);

/// Log density at a point, up to a constant; −infinity outside the box or where not allowed.
double log_density(const Emulator& emulator, const Box& box, const Observed& observed, const Eigen::VectorXd& point);

}  // namespace millscope::emulate
