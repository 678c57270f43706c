// The plugin library `mesh`.
#include "geometry/import/guarded_import.hpp"
#include "geometry/mesh/mesh.hpp"

#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

double metres_per_unit(const std::string& unit) {
  if (unit == "mm") return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "inch") return 0.0254;
  if (unit == "m") return 1;
  throw Refusal("mesh: unit is missing: write unit: mm, m, cm or inch, in which the file was drawn");
}

Point point_of(const double* x) { return {x[0], x[1], x[2]}; }

MeshOptions options_of(const Parameters& p) {
  MeshOptions o;
  o.label = p.text("file");
  o.placement.scale = metres_per_unit(p.text("unit")) * p.number("scale");
  o.placement.axis = p.text("axis");
  o.placement.centre = p.flag("centre");
  o.placement.rotate_axis = point_of(p.vector("rotate_axis"));
  o.placement.rotate_angle = p.number("rotate_angle");
  o.placement.translate = point_of(p.vector("translate"));
  o.placement.repeat = static_cast<int>(p.integer("repeat"));
  o.period = p.number("period");
  o.max_triangles = as_size(p.integer("max_triangles"));
  return o;
}

Soup import_file(const Parameters& p) {
  ImportLimits limits;
  limits.max_triangles = as_size(p.integer("max_triangles"));
  metres_per_unit(p.text("unit"));  // before the long part
  return import_mesh(p.text("file"), limits);
}

}  // namespace

MeshPlugin::MeshPlugin(const Parameters& parameters) : Mesh(import_file(parameters), options_of(parameters)) {}

}  // namespace millscope::geometry

namespace {

using namespace millscope;

constexpr Parameter kParameters[] = {
    file_parameter("file", "STL, OBJ, PLY, OFF, glTF, GLB or 3MF file; one material slot per solid name, \"all\" for unnamed ones."),
    choice_parameter("unit", "mm|m|cm|inch", nullptr, "Unit in which the file was drawn; required, so that nobody is off by a thousand."),
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

constexpr Descriptor kMesh = describe<geometry::MeshPlugin>({
    .name = "mesh",
    .version = "0.1.0",
    .doc = "Triangle mesh from a CAD file; exact sphere-triangle contact, shared edges and vertices count once.",
    .equation = "delta = r - |x - nearest point of the triangle|",
    .citation = "Ericson 2005, Real-Time Collision Detection, section 5.1.5",
    .parameters = kParameters,
});

}  // namespace

MILLSCOPE_PLUGINS(&kMesh)
