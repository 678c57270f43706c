// A Gaussian-process emulator: what the simulation would say at parameters where it was not run, and how sure that is.
#pragma once

#include <cstdint>
#include <memory>

#include "studies/emulate/space.hpp"

namespace millscope::emulate {

enum class Kernel {
  matern52,  ///< k = s² (1 + √5 r + 5 r²/3) exp(−√5 r): twice differentiable; does not promise more smoothness than is known
  squared_exponential  ///< k = s² exp(−r²/2): infinitely smooth
};

enum class Trend { automatic, linear, quadratic };  ///< automatic: quadratic where the left-out runs are better predicted by it

struct FitOptions {
  Kernel kernel = Kernel::matern52;
  Trend trend = Trend::automatic;
  int starts = 4;          ///< searches for the hyper-parameters, from different points; the best is kept
  std::uint64_t seed = 1;  ///< of the starts
  int threads = 1;         ///< 0: all cores; the result does not depend on it
};

/// One value per observable. `variance`: of the simulation's mean at this point, from what the runs leave open: their noise, their
/// distances and, in `nugget`, what neither explains. `noise`: what one more run there would scatter about its mean (the runs' median).
struct Prediction {
  Eigen::VectorXd mean, variance, nugget, noise;
};

/// Each run predicted from the others, without fitting the hyper-parameters again (Dubrule 1983).
struct Diagnostics {
  Eigen::MatrixXd predicted;     ///< runs × observables
  Eigen::MatrixXd deviation;     ///< standard deviation of (run − predicted), the run's noise included
  Eigen::MatrixXd standardised;  ///< (run − predicted)/deviation; beyond 3: look at that run
  Eigen::VectorXd coverage90;    ///< fraction of runs inside their 90 % interval, by observable; nominal 0.9
  Eigen::VectorXd mean_square;   ///< of the standardised residuals; nominal 1
  Eigen::VectorXd predictivity;  ///< 1 − Σ residual²/Σ (run − mean)²: 1 perfect, 0 no better than the mean
  double coverage90_all = 0;     ///< over all observables
};

/// What was fitted for one observable; lengths in units of half the parameter's range.
struct Hyperparameters {
  Trend trend;
  Eigen::VectorXd length;
  double deviation;         ///< s, units of the observable
  double nugget_deviation;  ///< units of the observable
  double inflation;         ///< the variance of predictions is multiplied by it: mean square of the left-out residuals where above 1
  double log_likelihood;    ///< restricted, penalised; of the observable in units of its spread
};

class Emulator {
 public:
  /// Needs at least parameters + 3 runs. Throws base::UserError for numbers that are not finite, observables that never change,
  /// parameters that were never varied or only together, negative variances.
  static Emulator fit(const Box& box, const Training& training, const FitOptions& options = {});

  Prediction at(const Eigen::VectorXd& point) const;
  /// Covariance of the emulator's errors between observables at a point: variance + nugget on the diagonal, correlated as the residuals of
  /// the left-out runs are (shrunk towards none after Schäfer & Strimmer 2005).
  Eigen::MatrixXd covariance(const Prediction& prediction) const;
  /// Those correlations: observables × observables.
  const Eigen::MatrixXd& correlation() const;
  Diagnostics leave_one_out() const;
  const Hyperparameters& hyperparameters(Eigen::Index observable) const;
  /// This emulator as if a run at the point had said what is predicted there: to choose several points at once.
  Emulator believing(const Eigen::VectorXd& point) const;

  Eigen::Index observables() const;
  const Training& training() const;
  const Box& box() const;

  struct State;
  explicit Emulator(std::shared_ptr<const State> state);

 private:
  std::shared_ptr<const State> state_;
};

}  // namespace millscope::emulate
