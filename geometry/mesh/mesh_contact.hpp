// From candidate triangles to contacts: what a bead really touches.
//
// A bead touches a surface where its distance from the centre has a local minimum. The nearest point of one triangle is such a minimum
// unless it lies on the triangle's rim and a neighbour leads nearer. So, for one bead:
//   1. a hit on a face counts;
//   2. a hit on an edge or vertex counts unless another triangle that contains this place is nearer; of equally near ones the face
//      counts before the edge before the vertex, then the lowest index. "Contains" means by welded vertices, or, where the mesh has
//      T-junctions, within the weld tolerance;
//   3. of hits whose normals differ by less than 20° the nearest counts, if both are on faces or on one smooth patch: a tessellated
//      shell touches once.
// Contacts come nearest first. Two contacts on one patch (a bead across a groove) get features of their own.
#pragma once

#include <vector>

#include "geometry/mesh/triangle_record.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

class MeshContact {
 public:
  MeshContact() = default;
  /// `weld`: tolerance within which a place lies on a triangle, m.
  MeshContact(Triangles triangles, double weld) : triangles_(std::move(triangles)), weld_(weld) {}

  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const;

  const Triangles& triangles() const { return triangles_; }
  void prefetch(std::uint32_t triangle) const { __builtin_prefetch(&triangles_.planes[triangle]); }

 private:
  struct Hit;
  struct Hits;
  void collect(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, Hits& hits) const;
  bool contains(const Hit& other, const Hit& hit, const Point& centre) const;
  bool is_real(const Hits& hits, int i, const Point& centre) const;
  void report(const WallBead& bead, const Hits& hits, WallContacts& out) const;

  const TriangleRecord& record(const Hit& hit) const;

  Triangles triangles_;
  double weld_ = 0;
};

}  // namespace millscope::geometry
