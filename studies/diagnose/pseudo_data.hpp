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
  Index freed = -1;  ///< a nuisance that stays where it was fitted; the others are drawn from their priors
};

/// How much of a left-out run's deviation a pseudo-recording has beside the recording's noise: what the surrogate may be wrong by, or all.
enum class Deviation { surrogate_error, whole };

/// θ and shares one after the other, as `Model` counts them.
VectorXd coordinates_of(const VectorXd& coded, const std::vector<double>& shares);

/// What is refitted: some rivals of the problem switched on together; none: the base.
using Choice = std::vector<int>;

class PseudoData {
 public:
  explicit PseudoData(const Problem& problem, const NamingOptions& options);

  const Surrogate& surrogate() const { return *surrogate_; }
  std::size_t laws() const { return noise_factors_.size(); }
  const MatrixXd& covariance() const { return covariance_; }
  double chance() const { return chance_; }
  const MatrixXd& whitening() const { return whitener_; }
  /// The observations themselves, or draw `b` of `truth`.
  FitResult fit(const Choice& choice) const;
  Truth truth(const Choice& choice, const FitResult& fit) const;

  /// Fits of the choices to one draw each: [draws][choices]. Draw b has the noise of law b % laws(). `stream` keeps draws of different
  /// questions apart.
  struct Drawn {
    std::vector<FitResult> fit;
    VectorXd truth;     ///< coded θ, nuisances as they were drawn
    VectorXd residual;  ///< of the first choice: y* − m
    VectorXd rise;      ///< of its Q when one of θ and the shares is held at its truth; empty unless asked for
  };
  struct Draws {
    int count = 0;
    std::uint64_t stream = 0;
    Deviation deviation = Deviation::surrogate_error;
    bool rises = false;
  };
  std::vector<Drawn> draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const;

  /// 90 % intervals of θ and the shares of a fit to the observations, in coded units (intervals.cpp).
  std::vector<Interval> intervals(const Choice& choice, const FitResult& fit, const Draws& how) const;

 private:
  struct LeftOut {
    std::unique_ptr<Surrogate> surrogate;
    VectorXd deviation;  ///< y_r − m₋r(θ_r, s_r)
    double leverage = 0;
    int candidate = -1;  ///< that the run has on
  };
  std::vector<const LeftOut*> fitting(const Truth& truth) const;
  Model model(const Surrogate& surrogate, const Choice& choice) const;
  /// θ of the truth with nuisances from their priors.
  VectorXd drawn_theta(const Truth& truth, emulate::Random& random) const;
  VectorXd pseudo_recording(const LeftOut& left, const Truth& truth, double chance, const MatrixXd& noise, emulate::Random& random) const;

  const Problem& problem_;
  const NamingOptions& options_;
  std::unique_ptr<Features> features_;
  std::unique_ptr<Surrogate> surrogate_;
  std::vector<ShareRange> ranges_;
  std::vector<LeftOut> left_out_;
  double chance_ = 0;  ///< ρ
  MatrixXd covariance_, whitener_;
  std::vector<MatrixXd> noise_factors_;
};

}  // namespace millscope::diagnose
