// Predictions held against a recording, and how far a predicted one may be relied on; for the files of this room.
//
//   improvement = [(y − b)ᵀ C⁻¹ (y − b) − (y − a)ᵀ C⁻¹ (y − a)]/n,  C = recording + (C_a + C_b)/2
//
// a is the corrected model, b a rival. An error e of the surrogate that both share moves it by 2 dᵀC⁻¹e/n to first order, with the
// difference d = a − b: of e only the part along d matters (errors of their own count in the interval). So the left-out deviations e_r of
// the runs are taken along d, in noise units:
//
//   relied on where  √⟨(dᵀC⁻¹e_r)²⟩/|d| < |d|/2,  |d|² = dᵀC⁻¹d
#pragma once

#include <vector>

#include "studies/diagnose/verdict/held_out.hpp"

namespace millscope::diagnose {

/// `left_out`: deviations of left-out runs [runs, observables], one matrix for each group of runs; the group that errs most counts. A group
/// without runs tells nothing: the error is infinite.
Reliance reliance(const VectorXd& difference, const MatrixXd& covariance, const std::vector<MatrixXd>& left_out);

/// The rival with the smallest improvement; of none: 0.
std::size_t strongest(const std::vector<base::Interval90>& improvements);
/// Which rivals may be the strongest: it, and all that are within two standard errors of it.
std::vector<std::size_t> near_strongest(const std::vector<base::Interval90>& improvements);

struct Judge {
  std::vector<Index> kept;  ///< observables that every prediction defines; of these are the others
  VectorXd observed;
  MatrixXd recording;              ///< covariance: the weight
  naming::Noise noise;             ///< the same
  std::vector<MatrixXd> left_out;  ///< of the bank's runs: without a candidate, with that of the corrected model
  double power = 0;

  /// The predictions that have not failed decide what is kept.
  static Judge of(const naming::Problem& held, const std::vector<MatrixXd>& left_out, const std::vector<Prediction>& predictions);

  /// Misfit, and reliance on what differs from the recording.
  Score score(Prediction prediction) const;
  /// Improvement of the first prediction over another, with what noise of recording and predictions leaves open. Reliance on what differs
  /// between them.
  void compare(const Score& corrected, Score& rival, std::uint64_t seed) const;
  /// How often a recording of this very prediction would look as bad.
  double goodness(const Prediction& whole, std::uint64_t seed) const;

 private:
  Prediction part(const Prediction& p) const;
};

}  // namespace millscope::diagnose
