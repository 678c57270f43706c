// Beads from a file: a line of heads, then a bead a row.
//
//   x [mm], y [mm], z [mm], diameter [mm], material, vx [m/s], vy [m/s], vz [m/s]
//
// Needed: x, y, z, and diameter or radius. At will: material, velocity vx, vy, vz, spin wx, wy, wz. Apart by commas, semicolons, tabs or
// blanks. A head without a unit is SI, as numbers of a case are; other heads are passed over. Lines that begin with # are none.
#pragma once

#include <string>
#include <vector>

#include "kernel/config/case.hpp"

namespace millscope::config {

/// At least one bead; their classes are not known yet. Throws base::UserError with file and line.
std::vector<PlacedBead> read_bead_file(const std::string& path);

/// Reads fill.file. Each bead is of the class whose material is its own and in whose range of sizes its diameter lies; shares of the
/// classes, and of their sizes by the nearest one, become those of the file. Throws base::UserError with the line of a bead of no class or
/// of several.
void place_beads(Case& c);

}  // namespace millscope::config
