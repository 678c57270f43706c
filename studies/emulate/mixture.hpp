// A rough picture of a density with several hills, learnt by drawing from it again and again (population Monte Carlo; Cappé et al. 2004).
//
//   q(u) = mean over centres c_j of N(u; c_j, S)
//
// The centres are drawn by the weights p/q of the draws before, flattened so that a twentieth of them counts; S is the mean square of the
// differences to the nearest tenth of the centres: it follows the hills, not the distances between them. As a proposal of Markov chains it
// leads from hill to hill.
#pragma once

#include <Eigen/Cholesky>
#include <functional>

#include "kernel/base/random.hpp"

namespace millscope::emulate {

using LogDensity = std::function<double(const Eigen::VectorXd& coded)>;

class Mixture {
 public:
  /// From the prior's points (parameters × many; coded).
  Mixture(const LogDensity& density, const Eigen::MatrixXd& prior_points, base::RandomStream& random);

  Eigen::VectorXd draw(base::RandomStream& random) const;
  double log_density(const Eigen::VectorXd& coded) const;
  /// Different points among the last draws, by their flattened weights: starts for chains. Parameters × count.
  Eigen::MatrixXd starts(Eigen::Index count, base::RandomStream& random) const;

 private:
  void learn(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights, base::RandomStream& random);
  Eigen::MatrixXd points_, centres_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd root_;          // of S
  Eigen::MatrixXd inverse_root_;  // of S
  Eigen::MatrixXd whitened_;      // centres
  double log_scale_ = 0;
};

}  // namespace millscope::emulate
