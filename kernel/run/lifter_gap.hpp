// How wide the gaps between a mill's lifters are, measured on the surface, so that a mesh and a mill by numbers are alike.
#pragma once

#include <optional>

#include "millscope/geometry.hpp"

namespace millscope::run {

/// Width (m) of the narrowest gap between neighbouring lifters, at half of the lifters' height, in the middle of the mill, as far as it
/// can be seen from the axis. Nothing where there are no lifters (or but one, or lower ones than a bead of that radius feels), and where
/// the surface is no cylinder about z. A round shell's facets are no lifters.
std::optional<double> narrowest_lifter_gap(const Surface& surface, const Interior& interior, double bead_radius);

}  // namespace millscope::run
