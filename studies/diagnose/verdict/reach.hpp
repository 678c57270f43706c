// What a first look at the fits asks of the bank: simulations beyond a range that turns out too narrow, more with a candidate that helps,
// and with two candidates at once.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/diagnose/bank/beyond.hpp"
#include "studies/diagnose/verdict/recorded_problem.hpp"

namespace millscope::diagnose {

/// Ends at which fits stand and beyond which the case allows more: of parameters and nuisances where the base's fit does, or that of an
/// alternative that helps; of priors where such a candidate's does.
std::vector<End> ends_reached(const Question& question, const naming::Problem& problem);

/// Alternatives with candidates.
struct AskedFor {
  std::vector<Index> helpful;
  std::vector<std::pair<Index, Index>> pairs;
};

/// `helpful`: each candidate that helps as much as the best, where that may be named. The verdict hangs on what the surrogate says of it:
/// what is wrong there for want of runs looks like more missing physics. `pairs`: each of them with each other that may be beside it. What
/// a second does beside the first may be quite another thing than what it does alone (worn lifters where beads resist rolling), so that
/// without simulations of both it cannot be looked for. `noise_units`: what surely does less, by itself, is left out.
AskedFor asked_for(const naming::Problem& problem, double noise_units);

/// "bead_friction: a fit stands at the upper end of its range, 0.6; simulated up to 0.85".
std::string sentence_of(const Question& before, const End& end);

/// What of a fit lies outside the ranges of the study as it was asked: "bead_friction = 0.71 lies outside its range 0.1 … 0.6".
std::vector<std::string> outside_ranges(const Question& asked, const naming::Problem& problem, const naming::FitResult& fit,
                                        const std::vector<naming::ActiveCandidate>& active);

}  // namespace millscope::diagnose
