// The inside of an axis-aligned box, any of whose faces may be open.
//
// A closed face ends at the box's edges: above an open top a bead may hang on the rim of a wall (nearest point of the rectangle).
#pragma once

#include "geometry/shapes/triangulation.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

class Box {
 public:
  explicit Box(const Parameters& parameters);

  const std::string& material_slots() const { return slots_; }
  const std::string& report() const { return report_; }
  Surface surface() const { return triangles_.view(); }
  Interior interior() const;
  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const;
  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const;

 private:
  void add_face(int face);

  double low_[3], high_[3];
  bool open_[6] = {};  // −x, +x, −y, +y, −z, +z
  std::string slots_, report_;
  std::uint32_t slot_[6] = {};
  std::uint32_t first_triangle_[6] = {};
  Triangulation triangles_;
};

}  // namespace millscope::geometry
