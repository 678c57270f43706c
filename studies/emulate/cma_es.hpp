// CMA-ES: minimises without an emulator, from nothing but the ranks of the results (Hansen 2016, arXiv:1604.00772).
//
// Own and small instead of pagmo's: that one runs the objective itself, in one process and to its end, where a campaign asks for points,
// comes back hours later from another process and has failed runs; and Debian's build of it crashes in programs compiled for AVX2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/emulate/space.hpp"

namespace millscope::emulate {

class CmaEs {
 public:
  /// `start`: an allowed point, natural units; `sigma`: first step, as a fraction of the ranges (0.3 is usual); `population` 0: 4 + 3
  /// ln(parameters).
  CmaEs(const Box& box, const Eigen::VectorXd& start, double sigma, std::uint64_t seed, int population = 0);

  /// The points of this generation, all in the box and allowed; the same until `tell`.
  std::vector<Eigen::VectorXd> ask();
  /// Their values in the same order; +infinity for a simulation that failed. Throws std::invalid_argument for NaN, −infinity, a wrong
  /// number.
  void tell(const std::vector<double>& values);

  /// Best point told of and its value; before any: the start and +infinity.
  const Eigen::VectorXd& best() const;
  double best_value() const;
  /// The distribution's middle, often better than `best` where the values are noisy.
  Eigen::VectorXd mean() const;
  int generation() const;
  double sigma() const;
  /// Why it makes no sense to go on; empty while it does.
  std::string finished() const;

  /// All that is needed to go on, as JSON, points asked for but not told of included.
  std::string save() const;
  /// Throws base::UserError when the text is no state or of another number of parameters.
  static CmaEs restore(const Box& box, const std::string& state);

 private:
  struct State {
    Eigen::VectorXd mean, path_sigma, path_covariance, best;
    Eigen::MatrixXd covariance;
    std::vector<Eigen::VectorXd> asked;
    std::vector<double> history;
    double sigma = 0, best_value = 0;
    int generation = 0, population = 0;
    std::uint64_t random = 0;
  };
  CmaEs(const Box& box, State state);
  void recombine(const std::vector<std::size_t>& order);
  Box box_;
  State state_;
};

}  // namespace millscope::emulate
