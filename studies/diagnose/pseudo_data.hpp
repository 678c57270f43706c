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
  VectorXd coordinates() const;
};

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
    VectorXd residual;  ///< of the first choice: y* − m
    VectorXd rise;      ///< of its Q when one of θ and the shares is held at its truth; empty unless for intervals
  };
  struct Draws {
    int count = 0;
    std::uint64_t stream = 0;
    bool for_intervals = false;  ///< with all of a left-out run's deviation, ρ = 0
  };
  std::vector<Drawn> draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const;

  /// 90 % intervals of θ and the shares of a fit to the observations, in coded units (intervals.cpp).
  std::vector<Interval> intervals(const Choice& choice, const FitResult& fit, int draws, std::uint64_t stream) const;

 private:
  struct LeftOut {
    std::unique_ptr<Surrogate> surrogate;
    VectorXd deviation;  ///< y_r − m₋r(θ_r, s_r)
    double leverage = 0;
    std::vector<Effect> effects;
    int candidate = -1;  ///< that the run has on
  };
  void weigh_effects();
  /// Variance of the surrogate's error with effects over that without.
  double error_of(const std::vector<Effect>& effects) const;
  /// Runs whose deviations stand for the surrogate's error under a truth: those without an effect, and those with the effects that it has.
  /// For intervals these alone where there are enough: what the surrogate cannot follow of an effect lies along it.
  std::vector<const LeftOut*> runs_for(const Truth& truth, bool for_intervals) const;
  double allowed(const std::vector<Drawn>& drawn, const Model& fitted, Index coordinate) const;
  static VectorXd rise(const Model& model, const Truth& truth, double least, const VectorXd& y);
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
  std::vector<double> error_with_;  ///< of candidates: `error_of` at their strongest
  double chance_ = 0;               ///< ρ
  MatrixXd covariance_, whitener_;
  std::vector<MatrixXd> noise_factors_;
};

}  // namespace millscope::diagnose
