// A rigid body that beads touch: its surface is a geometry, its motion is prescribed.
#pragma once

#include <string>
#include <vector>

#include "kernel/dem/motion.hpp"
#include "millscope/geometry.hpp"

namespace millscope::dem {

struct Body {
  std::string name;
  const GeometryTable* table = nullptr;
  void* self = nullptr;
  Motion motion;
  std::vector<int> material_of_slot;  ///< material index of each slot of the geometry
  double greatest_distance = 0;       ///< of its surface from the axis of rotation, m
  bool per_triangle = false;          ///< keep impact and shear work, and wear, per triangle
  std::uint64_t triangle_count = 0;
};

}  // namespace millscope::dem
