// What shares an edge with what: open edges, smooth patches, connected parts, orientation.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/indexed_mesh.hpp"

namespace millscope::geometry {

/// Neighbours whose planes differ by less than this belong to one smooth patch: a tessellated shell is one surface to a bead that
/// slides over it. 20° keeps lifter faces (usually 30° and more) apart and joins shells of 18 and more facets.
inline constexpr double kSmoothCosine = 0.93969262078590838;  // cos 20°

struct Topology {
  std::vector<std::uint32_t> patch;      ///< per triangle, numbered from 0 in the order of their first triangle
  std::uint32_t patches = 0, parts = 0;  ///< smooth patches; connected parts
  std::size_t open_edges = 0;            ///< edges of one triangle only
  std::size_t shared_edges = 0;          ///< edges of two
  std::size_t crowded_edges = 0;         ///< edges of three and more
  std::size_t turned_edges = 0;          ///< edges whose two triangles are wound against each other
};

Topology find_topology(const IndexedMesh& mesh);

}  // namespace millscope::geometry
