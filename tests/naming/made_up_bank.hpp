// A mill that is a formula: observables that are quadratic in two frictions and a filling, and the effects of candidates, with noise.
#pragma once

#include "studies/diagnose/naming/naming.hpp"

namespace millscope::naming {

struct MadeUp {
  int runs = 24, each = 10, again = 0;  ///< of the runs without a candidate, as many are repeated
  double run_noise = 0.3, recording_noise = 1.0;
  double weakest = 0.55;                 ///< strength of a candidate in the bank
  double chancier = 1;                   ///< noise of runs with an effect over that of the others
  int conditions = 2, observables = 18;  ///< of each
  double cubic = 0;                      ///< what no quadratic surface follows
  double whole = 0;         ///< above 0: what is visible begins slowly, as x² (3 − 2 x) with x = s/whole, and is whole at x = 1
  bool goes_again = false;  ///< what is visible is 4 s (1 − s): nothing at full strength
  double flattens = 0;      ///< 1: bead friction does nothing more at the upper end of its range
};

/// What the formula says at coded θ with strengths of three candidates: "visible" changes what friction cannot, "concealed" does what
/// bead friction does, "faint" nearly nothing.
VectorXd truth_of(const MadeUp& mill, const VectorXd& coded, const std::vector<double>& strengths);

/// Bank and recording of the formula with the truth given.
Problem made_up_problem(const MadeUp& mill, const VectorXd& coded, const std::vector<double>& strengths, std::uint64_t seed);

}  // namespace millscope::naming
