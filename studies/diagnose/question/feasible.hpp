// Which values a case may have at all. For the files of this room.
#pragma once

#include <string>
#include <vector>

#include "studies/diagnose/question/question.hpp"

namespace millscope::diagnose {

/// The case of the first fitted condition with some settings, written out; throws base::UserError where plugins or reader refuse it.
std::string resolved(const calibrate::Study& study, const std::vector<std::string>& settings, const host::Registry& registry);

/// Fills Question::farthest and Candidate::prior and ::farthest: how far the bank may reach where a fit stands at an end.
void find_farthest(const host::Registry& registry, Question& question);

/// Candidates that no case may have at once, strong or faint, exclude one another, rather than that all their simulations fail.
void exclude_impossible(const host::Registry& registry, Question& question);

}  // namespace millscope::diagnose
