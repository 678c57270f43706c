// The plugin library `step`.
#include <opencascade/Standard_Version.hxx>

#include "geometry/import/cad_file.hpp"
#include "geometry/mesh/mesh.hpp"
#include "geometry/mesh/mesh_parameters.hpp"

namespace millscope::geometry {

struct StepPlugin : Mesh {
  explicit StepPlugin(const Parameters& p)
      : Mesh(import_cad(p.text("file"), cad_limits(as_size(p.integer("max_triangles"))),
                        {p.number("chord") / p.number("scale"), p.number("angle"), p.text("slots") == "colour"}),
             mesh_options(p, 1e-3, true)) {}
};

}  // namespace millscope::geometry

namespace {

using namespace millscope;

/// Part of this library's code, and so of the key under which a simulation is kept: another reader may cut other triangles.
[[gnu::used]] constexpr char kReader[] = "read_cad " MILLSCOPE_READ_CAD ", OpenCASCADE " OCC_VERSION_COMPLETE;

constexpr Parameter kOwn[] = {
    file_parameter("file", "STEP (AP203, AP214, AP242) or IGES file; it says its unit itself.", geometry::kCadExtensions),
    number_parameter("chord", "m", 2.5e-4, 1e-6, 0.1,
                     "Largest distance between a face and its triangles; a twentieth of a bead is plenty."),
    number_parameter("angle", "rad", 0.2, 0.01, 1, "Largest angle between neighbouring triangles of a curved face."),
    choice_parameter("slots", "name|colour", "name",
                     "What a material goes by: names of bodies, or colours as colour_ff8000 (red, green, blue), no_colour."),
};
constexpr geometry::MeshParameters kParameters(kOwn);

constexpr Descriptor kStep = describe<geometry::StepPlugin>({
    .name = "step",
    .version = "0.1.0",
    .doc = "CAD bodies from a STEP or IGES file, cut into triangles by OpenCASCADE; contact as of mesh.",
    .equation = "delta = r - |x - nearest point of the triangle|",
    .citation = "Ericson 2005, Real-Time Collision Detection, section 5.1.5; ISO 10303-21",
    .parameters = kParameters.items,
});

}  // namespace

MILLSCOPE_PLUGINS(&kStep)
