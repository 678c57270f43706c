// Walls as LIGGGHTS sees them: triangles, and which of them are one surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/dem/motion.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::engine::liggghts {

/// What a geometry has of one material, an STL file.
struct MeshFile {
  std::string id;  ///< of the fix
  std::string file;
  std::size_t body = 0;
  int type = 0;  ///< of LIGGGHTS
  std::vector<std::uint32_t> slots;
};
std::vector<MeshFile> meshes_of(const run::Assembly& a);

/// Its triangles, 3 vertices of the geometry's surface each.
std::vector<std::uint32_t> corners_of(const run::Assembly& a, const MeshFile& mesh);

/// Up to here LIGGGHTS may take faces for one surface, degrees: as geometry/mesh does.
inline constexpr double kSmoothDegrees = 20;

/// By how much neighbouring faces may turn and yet be one surface to LIGGGHTS, degrees, at most kSmoothDegrees. Edges inside one surface
/// push no bead. On a hollow shell that is right: with them a bead that sinks into softened HDPE was pushed by several facets, and the bed
/// of the story's mill stood 0.7 mm higher. On a ridge it is not: over an edge that does not push no face pushes either, and the bead falls
/// through. So it is 0.9 of the smallest turn of a ridge, and of a bend of a sharp one, that LIGGGHTS (0.256°) would not join by itself.
/// What is hollow and what a ridge is as seen from the axis of the wall's motion.
double smooth_degrees(const Surface& surface, const std::vector<std::uint32_t>& corners, const dem::Motion& motion);

}  // namespace millscope::engine::liggghts
