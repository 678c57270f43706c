// Reads STL, text or binary, with whole names and as precisely as it is written. Assimp reads in single precision, takes the first word of
// a name for the name, and stops at spellings that exporters do write.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace millscope::geometry {

struct Solid {
  std::string name;             ///< "" where the file gives none
  std::vector<double> corners;  ///< nine per triangle
};

/// What a file of triangles holds.
struct Solids {
  std::vector<Solid> solids;
  std::vector<std::string> notes;  ///< what was passed over
  bool single_precision = true;
};

/// Keywords in any case, apart or together ("endsolid", "END SOLID"); what a normal says is of no use and is not read. Throws Refusal.
Solids read_stl(std::string_view data, std::size_t max_triangles);

}  // namespace millscope::geometry
