// Units that cannot be meant. For the files of this room.
#pragma once

#include "studies/recording/description.hpp"

namespace millscope::recording {

/// Throws base::UserError at `where` when the points span more than any mill, or more or less than the mill that the condition states, or
/// when their 99th-percentile speed is above 3 √(2 g D); says which unit is probably meant. `time_unit`, `length_unit`: as written. Also
/// when the stated beads are larger than a third of that span, or the stated length does not fit the points.
void check_units(const std::vector<Run>& runs, const Condition& condition, const base::Location& where, const std::string& time_unit,
                 const std::string& length_unit);

}  // namespace millscope::recording
