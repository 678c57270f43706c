// Beads from a file: a line of heads, then a bead a row.
//
//   x [mm], y [mm], z [mm], diameter [mm], material, vx [m/s], vy [m/s], vz [m/s]
//
// Needed: x, y, z, and diameter or radius. At will: material, velocity vx, vy, vz, spin wx, wy, wz. Apart by commas, semicolons, tabs or
// blanks. A head without a unit is SI, as numbers of a case are; other heads are passed over. Lines that begin with # are none.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernel/base/vector3.hpp"
#include "kernel/config/case.hpp"

namespace millscope::config {

struct PlacedBead {
  std::size_t line = 0;                        ///< from 1
  base::Vector3 centre{}, velocity{}, spin{};  ///< m, m/s, rad/s
  double diameter = 0;                         ///< m
  std::string material;                        ///< "" where the file names none
};

/// At least one bead. Throws base::UserError with file and line.
std::vector<PlacedBead> read_bead_file(const std::string& path);

/// Of a bead of the file, by its material and its diameter, which lies in the range of one class. Throws base::UserError with its line.
std::size_t class_of(const std::vector<BeadCase>& classes, const PlacedBead& bead, const std::string& path);

/// Shares of the classes, and of their sizes by the nearest one, are those of the file.
void take_mixture(std::vector<BeadCase>& classes, const std::string& path);

}  // namespace millscope::config
