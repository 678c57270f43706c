// The plugin library `mesh`.
#include "geometry/import/mesh_file.hpp"
#include "geometry/mesh/mesh.hpp"
#include "geometry/mesh/mesh_parameters.hpp"

namespace millscope::geometry {

namespace {

double metres_per_unit(const std::string& unit) {
  if (unit == "mm") return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "inch") return 0.0254;
  if (unit == "m") return 1;
  throw Refusal("mesh: unit is missing: write unit: mm, m, cm or inch, in which the file was drawn");
}

Soup import_file(const Parameters& p) {
  ImportLimits limits;
  limits.max_triangles = as_size(p.integer("max_triangles"));
  metres_per_unit(p.text("unit"));  // before the long part
  return import_mesh(p.text("file"), limits);
}

}  // namespace

struct MeshPlugin : Mesh {
  explicit MeshPlugin(const Parameters& p) : Mesh(import_file(p), mesh_options(p, metres_per_unit(p.text("unit")), false)) {}
};

}  // namespace millscope::geometry

namespace {

using namespace millscope;

constexpr Parameter kOwn[] = {
    file_parameter("file", "STL, OBJ, PLY, OFF, glTF, GLB or 3MF file; one material slot per solid name, \"all\" for unnamed ones.",
                   "stl|obj|ply|off|gltf|glb|3mf"),
    choice_parameter("unit", "mm|m|cm|inch", nullptr, "Unit in which the file was drawn; required, so that nobody is off by a thousand."),
};
constexpr geometry::MeshParameters kParameters(kOwn);

constexpr Descriptor kMesh = describe<geometry::MeshPlugin>({
    .name = "mesh",
    .version = "0.1.0",
    .doc = "Triangle mesh from a CAD file; exact sphere-triangle contact, shared edges and vertices count once.",
    .equation = "delta = r - |x - nearest point of the triangle|",
    .citation = "Ericson 2005, Real-Time Collision Detection, section 5.1.5",
    .parameters = kParameters.items,
});

}  // namespace

MILLSCOPE_PLUGINS(&kMesh)
