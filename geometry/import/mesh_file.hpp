// Files of triangles: STL by our own reader, the others by assimp.
#pragma once

#include <string>

#include "geometry/import/guarded_import.hpp"

namespace millscope::geometry {

/// Triangles in the file's own unit, one slot per solid name. Throws Refusal: file, reason, remedy.
Soup import_mesh(const std::string& path, const ImportLimits& limits);

}  // namespace millscope::geometry
