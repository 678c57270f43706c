// The parameters' space and what a recording says: the plain data of this room.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace millscope::emulate {

/// Where the parameters may lie, in their natural units. Within it, every allowed point is as good as any other before the data speak.
struct Box {
  Eigen::VectorXd lower, upper;                              ///< one per parameter; lower < upper, both finite
  std::function<bool(const Eigen::VectorXd&)> allowed = {};  ///< constraints such as μ_r < μ_s; empty: none
  std::vector<std::string> name = {};                        ///< for messages; empty: "parameter 1", …

  Eigen::Index size() const { return lower.size(); }
  /// Inside the ranges and allowed.
  bool contains(const Eigen::VectorXd& point) const;
  /// Natural units to [-1, 1] and back.
  Eigen::VectorXd coded(const Eigen::VectorXd& point) const;
  Eigen::VectorXd natural(const Eigen::VectorXd& coded) const;
  std::string name_of(Eigen::Index parameter) const;
  /// Throws base::UserError when a range is empty, reversed or not finite.
  void check() const;
};

/// Simulations that came to an end; failed ones are left out by the caller.
struct Training {
  Eigen::MatrixXd input;                     ///< runs × parameters, natural units
  Eigen::MatrixXd output;                    ///< runs × observables
  Eigen::MatrixXd noise_variance;            ///< runs × observables: variance of the run's mean (another seed would differ by as much)
  std::vector<std::string> observable = {};  ///< for messages; empty: "observable 1", …
};

/// What was observed: the recording's observables with the covariance of the recording alone. What the emulator does not know, and through
/// it the noise of the simulations, is added where it is used.
struct Observed {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;  ///< symmetric, positive semidefinite
};

}  // namespace millscope::emulate
