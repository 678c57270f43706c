// Reads STL, text or binary, with whole names and as precisely as it is written. Assimp reads in single precision, takes the first word of
// a name for the name, and stops at spellings that exporters do write.
#pragma once

#include <string_view>

#include "geometry/import/answer.hpp"

namespace millscope::geometry {

/// Keywords in any case, apart or together ("endsolid", "END SOLID"); what a normal says is of no use and is not read. Throws Refusal.
Solids read_stl(std::string_view data, std::size_t max_triangles);

}  // namespace millscope::geometry
