// An endless plane; beads are on the side that its normal points to.
#pragma once

#include "geometry/shapes/triangulation.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

class Plane {
 public:
  explicit Plane(const Parameters& parameters);

  const std::string& material_slots() const { return slots_; }
  const std::string& report() const { return report_; }
  Surface surface() const { return triangles_.view(); }
  Interior interior() const { return {}; }
  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const;
  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const;

 private:
  Point normal_;
  double offset_;  // n · x of the plane
  std::string slots_ = "all", report_;
  Triangulation triangles_;
};

}  // namespace millscope::geometry
