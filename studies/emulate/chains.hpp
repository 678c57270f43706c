// Markov chains that learn their steps from each other: differential evolution (ter Braak 2006, Statistics and Computing 16, 239).
//
//   proposal of chain i:  u_i + γ (u_a − u_b) + ε,  a ≠ b ≠ i drawn among the population;  γ = 2.38/√(2 parameters), now and then 1 (from
//   mode to mode)
//
// A proposal beyond an end of the box is mirrored back, which keeps the steps symmetric. One proposal in ten comes from the mixture instead
// (independence sampler: its density enters the acceptance), so that hills far apart are visited as often as they deserve. Two populations
// that know nothing of each other: their agreement is the evidence that the chains have forgotten their starts.
#pragma once

#include <functional>
#include <vector>

#include "studies/emulate/mixture.hpp"

namespace millscope::emulate {

class Population {
 public:
  /// Learns the mixture from the prior's points (parameters × many; coded) and starts from its draws.
  Population(const LogDensity& density, const Eigen::MatrixXd& prior_points, int chains, std::uint64_t seed, std::uint64_t stream);

  /// Goes on for `draws` steps; the draws before are forgotten.
  void sample(int draws);
  /// [chain]: parameters × draws, and their log densities.
  const std::vector<Eigen::MatrixXd>& draws() const { return draws_; }
  const std::vector<Eigen::VectorXd>& log_density() const { return values_; }
  double acceptance() const { return static_cast<double>(accepted_) / static_cast<double>(proposed_); }

 private:
  void step(Eigen::Index chain);
  void accept(Eigen::Index chain, const Eigen::VectorXd& proposal, double log_correction);
  Eigen::VectorXd difference_step(Eigen::Index chain);
  LogDensity density_;
  base::RandomStream random_;
  Mixture mixture_;
  Eigen::MatrixXd position_;
  Eigen::VectorXd value_;
  std::vector<Eigen::MatrixXd> draws_;
  std::vector<Eigen::VectorXd> values_;
  long accepted_ = 0, proposed_ = 1;
};

/// Of one parameter, over chains of equal length: split R̂ and the effective number of draws (Gelman et al. 2013, 11.4–11.5).
struct Agreement {
  double r_hat, effective;
};
Agreement agreement(const std::vector<Eigen::VectorXd>& chains);

}  // namespace millscope::emulate
