// Triangles of a mill: the outline in short chords with their vertices on the true outline, swept along z, and its end faces.
#pragma once

#include <cstdint>
#include <optional>

#include "geometry/shapes/mill_profile.hpp"
#include "geometry/shapes/triangulation.hpp"

namespace millscope::geometry {

/// Material slots as the triangles and contacts number them; none where the mill has no such part.
struct MillSlots {
  std::uint32_t shell = 0;
  std::optional<std::uint32_t> lifter, end;
};

/// How many chords each piece of the outline is cut into, so that a contact finds its triangle without a search.
class MillSurface {
 public:
  /// `facet`: longest chord, m; `rows`: cuts along z.
  MillSurface(const MillProfile& profile, const MillSlots& slots, double facet, int rows);

  /// Triangle under a place of the outline at height z.
  std::uint32_t triangle_at(const ProfilePlace& place, double z) const;
  Surface view() const { return triangles_.view(); }

 private:
  void build_outline();
  void add_point(double x, double y, Piece piece);
  void add_piece(const double (&from)[2], const double (&to)[2], Piece piece);
  void add_arc(double from, double to);
  void add_walls(const MillSlots& slots);
  void add_end_face(std::uint32_t material, bool at_top);
  double fan_fraction() const;

  const MillProfile& profile_;
  Triangulation triangles_;
  std::vector<double> outline_;  // x, y of each point; closed
  std::vector<Piece> pieces_;    // of each chord
  int face_cuts_ = 0, top_cuts_ = 0, shell_cuts_ = 1, rows_;
};

}  // namespace millscope::geometry
