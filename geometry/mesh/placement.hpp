// Where a mesh stands: unit, rotation, repetition, and the search for its axis.
#pragma once

#include <string>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

/// Rows of a rotation matrix.
struct Rotation {
  Point row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Point operator()(const Point& p) const { return {dot(row[0], p), dot(row[1], p), dot(row[2], p)}; }
};

/// Rodrigues: by `angle` (rad) about `axis` (any length).
Rotation rotation_about(const Point& axis, double angle);
/// The shortest rotation that brings `direction` to z; the coordinate axes are exchanged in a cycle (x: y, z, x become x, y, z).
Rotation rotation_to_z(const Point& direction);

/// Axis of rotational symmetry, from the second moments of the surface
///   M = ∫ (x − g)(x − g)ᵀ dA,  g = ∫ x dA / ∫ dA:
/// a body that repeats itself three times or more round an axis has two equal eigenvalues, the axis is the third eigenvector.
struct Axis {
  bool found = false;
  Point point{0, 0, 0};      ///< centre of the surface, m
  Point direction{0, 0, 1};  ///< unit; its largest component is positive
  double asymmetry = 0;      ///< difference of the two equal moments over the largest; 0: perfect
};
Axis find_axis(const Soup& soup);

struct Placement {
  double scale = 1;        ///< unit and factor, m per unit of the file
  std::string axis = "z";  ///< auto, x, y, z: this becomes z
  bool centre = false;     ///< moves the axis to x = y = 0
  Point rotate_axis{0, 0, 0};
  double rotate_angle = 0;   ///< rad
  Point translate{0, 0, 0};  ///< m
  int repeat = 1;            ///< copies round z
};

/// In this order: scale, axis to z, centre, rotate, translate, repeat. Throws Refusal.
void place(Soup& soup, const Placement& placement);

}  // namespace millscope::geometry
