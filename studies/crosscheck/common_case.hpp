// The one case that both engines play.
#pragma once

#include <filesystem>

#include "kernel/host/registry.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::crosscheck {

/// Writes FOLDER/case.yaml: the case with as many beads as it counts, each geometry that is no mesh as the mesh that `geometry export`
/// makes of it (FOLDER/NAME.stl), and of the output only what the comparison reads. So both engines see the same triangles: a lifter whose
/// height is measured from a chord is higher than one that is measured from the circle. Returns the file. Throws base::UserError, also
/// where the triangles do not tell the inside that the geometry has: the beads would be put elsewhere.
std::filesystem::path write_common_case(const run::Assembly& a, const host::Registry& registry, const std::filesystem::path& folder);

}  // namespace millscope::crosscheck
