// Recordings as the numbers that a diagnosis has to explain.
#pragma once

#include <vector>

#include "studies/diagnose/bank/bank.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::diagnose {

/// Recordings of some conditions side by side, with the covariance
///
///   C = g P + U,  P: mean over simulations without a candidate of what resampling says, each scaled to the recording's variances;
///                 g: mean of vᵀ C_r v/vᵀ P v over those of P's own directions v that chance lets be alike;
///                 C_r: the recording's by resampling;
///                 U: errors that no resampling shows (an axis, a meter, readings)
///
/// A recording has some tens of independent blocks. They tell how large its errors are all together, with a third of so many degrees of
/// freedom for each direction (with fewer than 30 blocks those of one; CommonSize), but not those of 35 numbers beside one another: some of
/// their sums are known ten times better than each, which the chance of few blocks hides. Simulations through the same camera tell it.
/// Where the recording likely has more along one of P's own directions (95 %), that counts: what simulated beads do not have, a region that
/// they never visit, a camera that wanders. Figures without tracks have the errors that they state. To all powers that of the study is
/// added.
void add_recorded(const Question& question, const Evidence& evidence, const Bank& bank, const std::vector<std::size_t>& conditions,
                  naming::Problem& problem);

/// Bank and recordings of some conditions, with the alternatives of the question.
naming::Problem problem_of(const Question& question, const Evidence& evidence, const Bank& bank,
                           const std::vector<std::size_t>& conditions);

/// Bank and recording of one condition, each coordinate on the scale that `like` has chosen; without alternatives.
naming::Problem problem_alone(const Question& question, const Evidence& evidence, const Bank& bank, std::size_t condition,
                              const naming::BankData& like);

/// Candidates of the question and nuisances that may leave their prior.
std::vector<naming::Alternative> alternatives_of(const Question& question);

}  // namespace millscope::diagnose
