// Pseudo-recordings from left-out runs, and the models that refit them; for the files of this room.
#pragma once

#include <memory>
#include <vector>

#include "studies/diagnose/naming.hpp"
#include "studies/emulate/random.hpp"

namespace millscope::diagnose {

/// A model to draw from.
struct Truth {
  VectorXd coded;
  std::vector<Effect> effects;
};

/// What is refitted: some rivals of the problem switched on together; none: the base.
using Choice = std::vector<int>;

class PseudoData {
 public:
  explicit PseudoData(const Problem& problem, const NamingOptions& options);

  const Surrogate& surrogate() const { return *surrogate_; }
  const MatrixXd& covariance() const { return covariance_; }
  const MatrixXd& whitening() const { return whitener_; }
  /// The observations themselves, or draw `b` of `truth`.
  FitResult fit(const Choice& choice) const;
  Truth truth(const Choice& choice, const FitResult& fit) const;

  /// Fits of the choices to one draw each: [draws][choices]. `stream` keeps draws of different questions apart.
  struct Drawn {
    std::vector<FitResult> fit;
    VectorXd residual;  ///< of the first choice: y* − m
  };
  std::vector<Drawn> draw(const Truth& truth, const std::vector<Choice>& choices, int draws, std::uint64_t stream) const;

 private:
  struct LeftOut {
    std::unique_ptr<Surrogate> surrogate;
    VectorXd deviation;  ///< y_r − m₋r(θ_r)
    double leverage = 0;
  };
  Model model(const Surrogate& surrogate, const Choice& choice) const;
  VectorXd pseudo_recording(const LeftOut& left, const Truth& truth, emulate::Random& random) const;

  const Problem& problem_;
  const NamingOptions& options_;
  std::unique_ptr<Features> features_;
  std::unique_ptr<Surrogate> surrogate_;
  std::vector<ShareRange> ranges_;
  std::vector<LeftOut> left_out_;
  MatrixXd covariance_, whitener_, recording_factor_;
};

}  // namespace millscope::diagnose
