// Ranges that turn out too narrow: where a fit stands at an end, the bank reaches beyond it.
#pragma once

#include <string>
#include <vector>

#include "studies/diagnose/bank/beyond.hpp"
#include "studies/diagnose/verdict/recorded_problem.hpp"

namespace millscope::diagnose {

/// Ends at which fits stand and beyond which the case allows more: of parameters where the base's fit does, or that of a candidate that
/// helps; of priors where such a candidate's does.
std::vector<End> ends_reached(const Question& question, const naming::Problem& problem);

/// "bead_friction: a fit stands at the upper end of its range, 0.6; simulated up to 0.85".
std::string sentence_of(const Question& before, const End& end);

/// What of a fit lies outside the ranges of the study as it was asked: "bead_friction = 0.71 lies outside its range 0.1 … 0.6".
std::vector<std::string> outside_ranges(const Question& asked, const naming::Problem& problem, const naming::FitResult& fit,
                                        const std::vector<naming::ActiveCandidate>& active);

}  // namespace millscope::diagnose
