// Recordings as the numbers that a diagnosis has to explain.
#pragma once

#include <vector>

#include "studies/diagnose/bank/bank.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::diagnose {

/// Recordings of some conditions side by side. The sizes of their errors are the recordings' own, the power's widened by that of speed
/// and meter. What is not known well is how the errors of 35 numbers are correlated: a recording has ten or twenty independent blocks and
/// its correlations are shrunk towards none; those of simulated beads, the mean over the bank, know nothing of the camera's own wander.
/// Observables are weighed by the mean of both, and p-values hold under either as the law of noise.
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
