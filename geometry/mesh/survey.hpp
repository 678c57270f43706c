// What a user wants to know of a mesh before trusting it, and the space that it leaves to the charge.
#pragma once

#include <string>
#include <vector>

#include "geometry/mesh/indexed_mesh.hpp"
#include "geometry/mesh/placement.hpp"
#include "geometry/mesh/topology.hpp"
#include "millscope/geometry.hpp"

namespace millscope::geometry {

enum class Facing { inwards, outwards, both, mixed };

struct Survey {
  Bounds box;
  double area = 0;    ///< m²
  double volume = 0;  ///< signed, of a closed surface, m³
  bool closed = false;
  Axis axis;
  double inward_share = 0;  ///< of an open surface's area that looks along the axis or across it, not round it; of a closed one all or none
  Facing facing = Facing::both;
  Interior interior{};
};

Survey survey_mesh(const IndexedMesh& mesh, const Topology& topology);

std::string survey_text(const Survey& survey, const IndexedMesh& mesh, const Topology& topology, const std::vector<std::string>& names);

/// First surface that a look from the z axis outwards meets, its farthest place: the bare shell even when the mesh is a thick liner.
/// 0: most looks meet nothing.
double bare_radius(const IndexedMesh& mesh, const Bounds& box);

}  // namespace millscope::geometry
