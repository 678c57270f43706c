// Recordings as the numbers that a diagnosis has to explain.
#pragma once

#include <vector>

#include "studies/diagnose/bank.hpp"
#include "studies/diagnose/naming.hpp"

namespace millscope::diagnose {

/// Recordings of some conditions side by side, with their covariance. The sizes of the errors are the recording's own, the power's widened
/// by that of speed and meter. Correlations between observables lie half-way between the recording's, shrunk towards none because ten or
/// twenty independent blocks do not tell those of 35 numbers, and those of the simulated beads, the mean over the bank, which know nothing
/// of the camera's own wander.
void add_recorded(const Question& question, const Workshop& workshop, const Bank& bank, const std::vector<std::size_t>& conditions,
                  Problem& problem);

/// Bank and recordings of some conditions, with the rivals of the question.
Problem problem_of(const Question& question, const Workshop& workshop, const Bank& bank, const std::vector<std::size_t>& conditions);

/// Candidates of the question and nuisances that may leave their prior.
std::vector<Rival> rivals_of(const Question& question);

}  // namespace millscope::diagnose
