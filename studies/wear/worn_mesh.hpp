// A profile as triangles, and what each stretch of the profile has lost.
#pragma once

#include <span>
#include <vector>

#include "kernel/run/wear.hpp"
#include "studies/wear/profile.hpp"

namespace millscope::wear {

/// The profile cut into stretches of about one cell's length: where it is steep, between two directions, there are several.
struct Stretches {
  std::vector<std::size_t> parts;  ///< [columns] between a direction and the next
  std::vector<std::size_t> first;  ///< [columns + 1] index of the first of them
  std::size_t count() const { return first.back(); }
};
Stretches stretches_of(const Profile& p);

struct Place {
  double x, y;  ///< m, across the axis
};
/// Where part `part` of `parts` of the chord from direction `column` to the next begins, in the first pitch.
Place place_of(const Profile& p, std::size_t row, std::size_t column, double share);
/// Length of each stretch of a row, m.
std::vector<double> lengths_of(const Profile& p, const Stretches& s, std::size_t row);

/// Triangles of the whole mill; points into itself.
struct Mesh {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles, materials;
  Surface surface() const;
};
Mesh mesh_of(const Profile& p, const Stretches& s);

/// Where a triangle of the mill lies on the profile.
struct Spot {
  bool on_face = false;  ///< of an end; then the rest means nothing
  std::size_t pitch = 0, row = 0, column = 0;
  double share = 0;  ///< of the way from the column's direction to the next, 0…1
};
/// `vertices`: x, y, z of each, m; `corners`: the triangle's three.
Spot spot_of(std::span<const double> vertices, const std::uint32_t* corners, const Profile& p);

/// What a run took away, m³/s.
struct Loss {
  std::vector<std::vector<double>> of_pitch;  ///< [pitch][row · stretches + stretch]
  double faces = 0;                           ///< from the end faces
};
Loss loss_of(const run::WornSurface& worn, const Profile& p, const Stretches& s);

/// Spreads what each stretch has lost over its neighbours by a Gaussian of deviation `length`, m, along the surface and along the mill;
/// the sum stays.
void smooth(std::vector<double>& loss, const Profile& p, const Stretches& s, double length);

}  // namespace millscope::wear
