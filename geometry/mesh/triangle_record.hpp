// One triangle, ready for the nearest-point test: three cache lines, the first of which rejects most beads.
//
//   a, b, c     corners;  e = b − a, f = c − a
//   n, o        unit normal and offset, n·x = o in the plane
//   p           centre of the bead;  d1 = e·(p − a), d2 = f·(p − a)
//   v, w        barycentric weights of b and c at the foot of p:  v·D = d1 f² − d2 e·f,  w·D = d2 e² − d1 e·f,  D = e² f² − (e·f)²
//
// The regions are those of C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5; with d3…d6 of the book written as
// d1 − e², d2 − e·f, d1 − e·f, d2 − f², so that two dot products are enough.
#pragma once

#include <cstdint>

#include "geometry/mesh/indexed_mesh.hpp"

namespace millscope::geometry {

/// Where the nearest point lies. Edges and vertices are numbered by their first corner: edge_ab runs from a to b.
enum class Region : std::uint8_t { face, edge_ab, edge_bc, edge_ca, vertex_a, vertex_b, vertex_c };

inline bool is_face(Region r) { return r == Region::face; }
inline bool is_vertex(Region r) { return r >= Region::vertex_a; }

struct alignas(64) TriangleRecord {
  Point normal;
  double offset;
  Point a;
  std::uint32_t patch, slot;
  // second line
  Point e, f;
  double ee, ff;
  // third line
  double ef, inverse_d;
  std::uint32_t vertex[3];  ///< welded
  std::uint32_t source;     ///< index into the surface's triangles
  double spare[4];
};
static_assert(sizeof(TriangleRecord) == 192);

inline TriangleRecord make_record(const IndexedMesh& mesh, std::size_t t, std::uint32_t patch) {
  TriangleRecord r{};
  const Point area = double_area(mesh, t);
  r.a = mesh.vertex(t, 0);
  r.e = mesh.vertex(t, 1) - r.a;
  r.f = mesh.vertex(t, 2) - r.a;
  r.normal = (1 / length(area)) * area;
  r.offset = dot(r.normal, r.a);
  r.ee = dot(r.e, r.e), r.ff = dot(r.f, r.f), r.ef = dot(r.e, r.f);
  r.inverse_d = 1 / dot(area, area);
  for (std::size_t k = 0; k < 3; ++k) r.vertex[k] = mesh.triangles[t][k];
  r.patch = patch, r.slot = mesh.slots[t], r.source = mesh.source[t];
  return r;
}

struct Nearest {
  Point to_bead;   ///< from the nearest point to p
  double squared;  ///< m²
  Region region;
};

/// Nearest point of the triangle to p; `height` = n·p − o.
inline Nearest nearest_point(const TriangleRecord& t, const Point& p, double height) {
  const Point ap = p - t.a;
  const double d1 = dot(t.e, ap), d2 = dot(t.f, ap);
  const double v = d1 * t.ff - d2 * t.ef, w = d2 * t.ee - d1 * t.ef, u = 1 - (v + w) * t.inverse_d;
  if (u > 0 && v > 0 && w > 0) return {height * t.normal, height * height, Region::face};
  const auto at = [&](const Point& q, Region region) { return Nearest{q, dot(q, q), region}; };
  if (d1 <= 0 && d2 <= 0) return at(ap, Region::vertex_a);
  const double d3 = d1 - t.ee, d4 = d2 - t.ef, d5 = d1 - t.ef, d6 = d2 - t.ff;
  if (d3 >= 0 && d4 <= d3) return at(ap - t.e, Region::vertex_b);
  if (w <= 0 && d1 >= 0 && d3 <= 0) return at(ap - (d1 / t.ee) * t.e, Region::edge_ab);
  if (d6 >= 0 && d5 <= d6) return at(ap - t.f, Region::vertex_c);
  if (v <= 0 && d2 >= 0 && d6 <= 0) return at(ap - (d2 / t.ff) * t.f, Region::edge_ca);
  const double to_c = d4 - d3, to_b = d5 - d6, s = minimum(maximum(to_c / (to_c + to_b), 0.0), 1.0);
  return at(ap - t.e - s * (t.f - t.e), Region::edge_bc);
}

inline double height_above(const TriangleRecord& t, const Point& p) { return dot(t.normal, p) - t.offset; }

}  // namespace millscope::geometry
