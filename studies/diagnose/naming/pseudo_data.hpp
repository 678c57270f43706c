// Pseudo-recordings from left-out runs, and the models that refit them; for the files of this room.
//
// A pseudo-recording is a surrogate's prediction, the deviation of the run that was left out of it, and the recording's noise. Where its
// truth has candidates the bank is drawn again as well, because what is refitted has slopes with chance of their own:
//
//   without: y* = m₋r(θ, 0) + √((1 − ρ + h)/(1 + h_r)) d_r + ε,        refitted with m₋r
//   with:    y* = m°₋r(θ, s) + √((1 − ρ) e(s)/(e_r + h_r)) d_r + ε,    refitted with m°₋r + x ᵀE,  E ~ N(0, C ⊗ S)
//
// d_r, h_r: deviation of run r from the surrogate without it, and its leverage there; e: scatter of runs with a candidate over that
// without; C: Surrogate::coefficient_error(). m° has the slopes of the candidates that are there times the root of their reliability 1 −
// tr(Σ⁻¹ S) h/|W Δm|²: with E they are as large as those that the bank shows.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "kernel/base/random.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::naming {

/// A model to draw from.
struct Truth {
  VectorXd coded;
  std::vector<ActiveCandidate> active;
  std::optional<Index> freed = {};  ///< a nuisance that stays where it was fitted; the others are drawn from their priors
  VectorXd coordinates() const;
};

/// θ and strengths one after the other, as `Model` counts them.
VectorXd coordinates_of(const VectorXd& coded, const std::vector<double>& strengths);

/// What is refitted: some alternatives together; none: the base.
using Choice = std::vector<Index>;

class PseudoData {
 public:
  explicit PseudoData(const Problem& problem, const Options& options);

  const Surrogate& surrogate() const { return *surrogate_; }
  double chance() const { return chance_; }
  const Weighting& weighting() const { return *weighting_; }
  /// The observations themselves, or draw `b` of `truth`.
  FitResult fit(const Choice& choice) const;
  Truth truth(const Choice& choice, const FitResult& fit) const;

  /// Fits of the choices to one draw each: [draws][choices]. `stream` keeps draws of different questions apart.
  struct Drawn {
    std::vector<FitResult> fit;
    VectorXd residual;  ///< of the first choice, y* − m; empty where the bank was drawn again
    VectorXd rise;      ///< of its Q when one of θ and the strengths is held at its truth; empty unless for intervals
  };
  struct Draws {
    int count = 0;
    std::uint64_t stream = 0;
    bool for_intervals = false;  ///< with all of a left-out run's deviation, ρ = 0
  };
  std::vector<Drawn> draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const;

  /// 90 % intervals of θ and the strengths of a fit to the observations, in coded units (intervals.cpp).
  std::vector<base::Interval90> intervals(const Choice& choice, const FitResult& fit, int draws, std::uint64_t stream) const;

 private:
  struct LeftOut {
    std::unique_ptr<Surrogate> surrogate;
    VectorXd deviation;  ///< y_r − m₋r(θ_r, s_r)
    double leverage = 0;
    std::vector<ActiveCandidate> active;
  };
  /// A left-out run's models of some choices, and what draws under a truth do with its bank.
  struct Refit {
    const LeftOut* left = nullptr;
    MatrixXd coefficients;  ///< of m°₋r
    MatrixXd again;         ///< E = again · normals · Lᵀ with S = L Lᵀ; empty: the truth has no candidate
    MatrixXd whitened;      ///< W times the coefficients, observables × features; empty as well
    std::vector<Model> models;
  };
  Refit refit(const LeftOut& left, const Truth& truth, const std::vector<Choice>& choices) const;
  Drawn drawn(const Refit& refit, const Truth& truth, const Draws& how, std::size_t b) const;
  double reliability(const Truth& truth, const ActiveCandidate& candidate) const;
  /// Scatter of runs with candidates over that of runs without.
  double scatter_of(const std::vector<ActiveCandidate>& active) const;
  /// Runs whose deviations stand for the surrogate's error under a truth: those whose candidates it has, too, and those without
  /// one. For intervals these alone where there are enough: what the surrogate cannot follow of a candidate lies along it.
  std::vector<const LeftOut*> runs_for(const Truth& truth, bool for_intervals) const;
  double allowed(const std::vector<Drawn>& drawn, const Model& fitted, Index coordinate) const;
  static VectorXd rise(const Model& model, const Truth& truth, double least, const VectorXd& y);
  Model model(const Surrogate& surrogate, const Choice& choice) const;
  /// θ of the truth with nuisances from their priors.
  VectorXd drawn_theta(const Truth& truth, base::RandomStream& random) const;
  /// The part of the left-out run's deviation that a pseudo-recording has.
  double part_of(const LeftOut& left, const Truth& truth, double chance) const;

  const Problem& problem_;
  const Options& options_;
  std::unique_ptr<Features> features_;
  std::unique_ptr<Surrogate> surrogate_;
  std::vector<StrengthRange> ranges_;
  std::vector<LeftOut> left_out_;
  double chance_ = 0;  ///< ρ
  std::unique_ptr<Weighting> weighting_;
  MatrixXd run_white_;  ///< W L with L Lᵀ = S
  Noise noise_;
};

}  // namespace millscope::naming
