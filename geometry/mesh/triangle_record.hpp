// Triangles, ready for the nearest-point test. The planes stand apart: they reject most candidates and stay in the cache.
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
#include <vector>

#include "geometry/mesh/indexed_mesh.hpp"

namespace millscope::geometry {

/// Where the nearest point lies. Edges and vertices are numbered by their first corner: edge_ab runs from a to b.
enum class Region : std::uint8_t { face, edge_ab, edge_bc, edge_ca, vertex_a, vertex_b, vertex_c };

inline bool is_face(Region r) { return r == Region::face; }
inline bool is_vertex(Region r) { return r >= Region::vertex_a; }

/// All that most candidates are asked: how far from the plane.
struct TrianglePlane {
  Point normal;
  double offset;
};

struct alignas(64) TriangleRecord {
  Point a;
  std::uint32_t patch, slot;
  Point e, f;
  double ee, ff, ef, inverse_d;
  double far_a, far_b, far_c;  ///< squares of the altitudes on a, b, c (of b and c: over D²)
  std::uint32_t vertex[3];     ///< welded
  std::uint32_t source;        ///< index into the surface's triangles
};

struct Triangles {
  std::vector<TrianglePlane> planes;
  std::vector<TriangleRecord> records;

  std::size_t size() const { return records.size(); }
  void add(const IndexedMesh& mesh, std::size_t t, std::uint32_t patch);
  double height(std::size_t t, const Point& p) const { return dot(planes[t].normal, p) - planes[t].offset; }
};

inline void Triangles::add(const IndexedMesh& mesh, std::size_t t, std::uint32_t patch) {
  TriangleRecord r{};
  const Point area = double_area(mesh, t), normal = (1 / length(area)) * area;
  r.a = mesh.vertex(t, 0);
  r.e = mesh.vertex(t, 1) - r.a;
  r.f = mesh.vertex(t, 2) - r.a;
  r.ee = dot(r.e, r.e), r.ff = dot(r.f, r.f), r.ef = dot(r.e, r.f);
  r.inverse_d = 1 / dot(area, area);
  r.far_a = 1 / (r.inverse_d * (r.ee + r.ff - 2 * r.ef)), r.far_b = r.inverse_d / r.ff, r.far_c = r.inverse_d / r.ee;
  for (std::size_t k = 0; k < 3; ++k) r.vertex[k] = mesh.triangles[t][k];
  r.patch = patch, r.slot = mesh.slots[t], r.source = mesh.source[t];
  planes.push_back({normal, dot(normal, r.a)});
  records.push_back(r);
}

struct Nearest {
  Point to_bead;   ///< from the nearest point to p
  double squared;  ///< m²
  Region region;
};

/// Nearest point of triangle number `index` to p; `height` = n·p − o. When it is surely farther than √limit, only `squared` ≥ limit
/// is meant: the distance of the foot from the line of an edge is its weight times the altitude on that edge, and one comparison with
/// the largest of the three spares most neighbours the tests below, whose outcome no processor can guess.
[[gnu::always_inline]] inline Nearest nearest_point(const Triangles& triangles, std::size_t index, const Point& p, double height,
                                                    double limit) {
  const TriangleRecord& t = triangles.records[index];
  const Point ap = p - t.a;
  const double d1 = dot(t.e, ap), d2 = dot(t.f, ap);
  const double v = d1 * t.ff - d2 * t.ef, w = d2 * t.ee - d1 * t.ef, u = 1 - (v + w) * t.inverse_d;
  const double beyond_a = minimum(u, 0.0), beyond_b = minimum(v, 0.0), beyond_c = minimum(w, 0.0);
  const double beyond =
      maximum(beyond_a * beyond_a * t.far_a, maximum(beyond_b * beyond_b * t.far_b, beyond_c * beyond_c * t.far_c)) + height * height;
  // The allowance keeps rounding from rejecting what lies exactly on the limit.
  if (beyond * (1 - 1e-12) > limit) return {ap, beyond, Region::face};
  if (minimum(u, minimum(v, w)) > 0) return {height * triangles.planes[index].normal, height * height, Region::face};
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

}  // namespace millscope::geometry
