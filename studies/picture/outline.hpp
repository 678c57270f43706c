// The mill in a picture: the cut of its walls halfway along the axis.
#pragma once

#include <string>

#include "kernel/host/registry.hpp"
#include "millscope/geometry.hpp"
#include "studies/analysis/results.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::picture {

/// Where a surface meets the plane at z; lines that run along the bare shell of `radius` are left out, the circle stands for them.
std::vector<std::array<double, 4>> section_of(const Surface& surface, double z, double radius);

/// Shell and turning sense from the results, lifters from the case that they name, as they stand at the start. Without a case, or when it
/// cannot be read any more, the shell alone; `why` then holds the reason (empty: nothing lacks).
MillOutline outline_of(const analysis::ResultSet& results, const host::Registry& registry, std::string& why);

}  // namespace millscope::picture
