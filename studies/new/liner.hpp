// A liner's mesh: whether a mill can be made of it, and how.
#pragma once

#include "studies/new/mill.hpp"

namespace millscope::new_mill {

/// Units that a mesh may be drawn in, as the plugin has them.
std::vector<std::string> mesh_units(const host::Registry& registry);

/// Reads the mesh as 'geometry report' does. Throws UserError for one that no reader takes, and for one that is no ring round an axis.
Liner look_at_liner(const std::string& file, const std::string& unit, const host::Registry& registry);

}  // namespace millscope::new_mill
