// The parametric mill and the bare cylinder: an exact outline in x–y, straight along z, and flat ends.
#pragma once

#include <memory>

#include "geometry/shapes/mill_surface.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

class Mill {
 public:
  static MillShape mill_shape(const Parameters&);
  static MillShape cylinder_shape(const Parameters&);

  /// `facet`: longest chord of the triangles, m; `rows`: cuts along z.
  Mill(const char* kind, const MillShape& shape, double facet, int rows);
  Mill(Mill&&) = delete;  // the surface refers to the profile

  const std::string& material_slots() const { return slot_names_; }
  const std::string& report() const { return report_; }
  Surface surface() const { return surface_->view(); }
  Interior interior() const;
  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const;
  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const;

 private:
  std::uint32_t feature_of(const ProfileContact& contact) const;

  MillProfile profile_;
  MillSlots slots_;
  std::string slot_names_, report_;
  std::unique_ptr<MillSurface> surface_;
};

/// What the plugin tables are made of.
struct MillPlugin : Mill {
  explicit MillPlugin(const Parameters& p) : Mill("mill", mill_shape(p), p.number("facet"), static_cast<int>(p.integer("axial_cuts"))) {}
};
struct CylinderPlugin : Mill {
  explicit CylinderPlugin(const Parameters& p)
      : Mill("cylinder", cylinder_shape(p), p.number("facet"), static_cast<int>(p.integer("axial_cuts"))) {}
};

}  // namespace millscope::geometry
