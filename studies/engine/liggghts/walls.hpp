// Walls as LIGGGHTS sees them: triangles, and which of them are one surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
inline constexpr double kJoinedAnyway = 0.256235;

/// By how much neighbouring faces may turn and yet be one surface to LIGGGHTS, degrees: kSmoothDegrees where that is safe, and never less
/// than what LIGGGHTS joins by itself (kJoinedAnyway). Edges inside one surface push no bead. On a hollow shell that is right: with them a
/// bead that sinks into softened HDPE was pushed by several facets, and the bed of the story's mill stood 0.7 mm higher. On a ridge it is
/// not: over an edge that does not push no face pushes either, and the bead falls through. A corner too is silent where two of its edges
/// make a smaller angle. So it stays below (0.9 of)
///   - the turn of every edge that is not hollow: both its faces rise towards the mill's axis, and it lies in the outer part of the mill;
///   - the angles between all edges of each corner in the open: of three sharp ridges or free edges, or of two that are not in one line.
/// Edges at either end of the wall, where a slice goes on and a drum is closed, are not in the open. Where the inside
/// is no cylinder nothing is known, and LIGGGHTS' own rule holds.
double smooth_degrees(const Surface& surface, const Interior& inside, const std::vector<std::uint32_t>& corners);

/// Of a wall of a case.
inline double smooth_degrees(const run::Assembly& a, const MeshFile& mesh) {
  return smooth_degrees(a.geometries[mesh.body].surface, a.geometries[mesh.body].interior, corners_of(a, mesh));
}

}  // namespace millscope::engine::liggghts
