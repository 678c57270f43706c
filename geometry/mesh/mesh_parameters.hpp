// Parameters that every plugin of a mesh has, whatever its files are.
#pragma once

#include <iterator>

#include "geometry/mesh/mesh.hpp"
#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

inline constexpr Parameter kMeshParameters[] = {
    number_parameter("scale", "1", 1, 1e-6, 1e6, "Factor on top of the unit."),
    choice_parameter("axis", "z|x|y|auto", "z", "Axis of the file that becomes z, the mill axis; auto finds the axis of rotation."),
    flag_parameter("centre", false, "Moves the axis of rotation to x = y = 0."),
    vector_parameter("rotate_axis", "1", 0, "Axis of a further rotation, after axis and centre; any length."),
    number_parameter("rotate_angle", "rad", 0, -100, 100, "Angle of that rotation, right-handed."),
    vector_parameter("translate", "m", 0, "Shift, after the rotation."),
    integer_parameter("repeat", 1, 1, 1000, "Copies of the mesh round z, evenly spaced: for one segment of a liner."),
    number_parameter("period", "m", 0, 0, 50, "Length along z after which the mesh goes on as at its start (a periodic slice); 0: none."),
    integer_parameter("max_triangles", 5e6, 1, 1e8, "Files with more triangles are refused."),
};

/// A plugin's own parameters and those of every mesh.
template <std::size_t N>
struct MeshParameters {
  Parameter items[N + std::size(kMeshParameters)];

  constexpr explicit MeshParameters(const Parameter (&own)[N]) : items() {
    for (std::size_t i = 0; i < N; ++i) items[i] = own[i];
    for (std::size_t i = 0; i < std::size(kMeshParameters); ++i) items[N + i] = kMeshParameters[i];
  }
};

/// `says_unit`: the file says its unit itself.
inline MeshOptions mesh_options(const Parameters& p, double metres_per_unit, bool says_unit) {
  const auto point = [](const double* x) { return Point{x[0], x[1], x[2]}; };
  MeshOptions o;
  o.label = p.text("file");
  o.says_unit = says_unit;
  o.placement.scale = metres_per_unit * p.number("scale");
  o.placement.axis = p.text("axis");
  o.placement.centre = p.flag("centre");
  o.placement.rotate_axis = point(p.vector("rotate_axis"));
  o.placement.rotate_angle = p.number("rotate_angle");
  o.placement.translate = point(p.vector("translate"));
  o.placement.repeat = static_cast<int>(p.integer("repeat"));
  o.period = p.number("period");
  o.max_triangles = as_size(p.integer("max_triangles"));
  return o;
}

}  // namespace millscope::geometry
