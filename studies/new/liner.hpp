// A liner's file: whether a mill can be made of it, and how.
#pragma once

#include "studies/new/mill.hpp"

namespace millscope::new_mill {

/// Reads the file as 'geometry report' does. `unit` "" where the file says it. Throws UserError for one that no reader takes, and for one
/// that is no ring round an axis.
Liner look_at_liner(const std::string& file, const std::string& unit, const host::Registry& registry);

}  // namespace millscope::new_mill
