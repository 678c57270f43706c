// Triangles with shared vertices: corners that lie within the weld tolerance become one vertex, triangles without area and repeated
// triangles are dropped and counted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

/// Corners nearer to each other than this fraction of the box's diagonal are one vertex: files hold single precision, or six digits.
inline constexpr double kWeldFraction = 1e-6;

using Corners = std::array<std::uint32_t, 3>;

struct IndexedMesh {
  std::vector<Point> vertices;
  std::vector<Corners> triangles;
  std::vector<std::uint32_t> slots;           ///< per triangle
  std::vector<std::uint32_t> source;          ///< per triangle: itself, or the triangle that it is a periodic copy of
  std::size_t own = 0;                        ///< triangles that are no copies; they come first
  std::size_t degenerate = 0, duplicate = 0;  ///< dropped
  double weld = 0;                            ///< tolerance, m

  Point vertex(std::size_t triangle, std::size_t corner) const { return vertices[triangles[triangle][corner]]; }
};

/// `period` > 0: copies of the triangles, moved by ± period along z, stand at both ends, so that beads which cross the boundary of a
/// periodic slice feel the neighbour.
IndexedMesh index_mesh(const Soup& soup, double period);

/// Normal times twice the area.
inline Point double_area(const IndexedMesh& mesh, std::size_t t) {
  const Point a = mesh.vertex(t, 0);
  return cross(mesh.vertex(t, 1) - a, mesh.vertex(t, 2) - a);
}

}  // namespace millscope::geometry
