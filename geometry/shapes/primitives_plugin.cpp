// The plugin library `primitives`: cylinder, plane, box.
#include "geometry/shapes/box.hpp"
#include "geometry/shapes/mill.hpp"
#include "geometry/shapes/plane.hpp"

namespace {

using namespace millscope;

constexpr Parameter kCylinderParameters[] = {
    number_parameter("radius", "m", kRequired, 0.0025, 25, "Inner radius; the axis is z."),
    number_parameter("length", "m", kRequired, 1e-4, 50, "Length, from z = 0."),
    flag_parameter("end_faces", false, "Flat walls at z = 0 and z = length; false: the wall goes on along z."),
    number_parameter("facet", "m", 0.003, 1e-5, 10, "Longest chord of the triangles for pictures and export; contact is exact anyway."),
    integer_parameter("axial_cuts", 1, 1, 1000, "Rows of triangles along z."),
};
constexpr Parameter kPlaneParameters[] = {
    vector_parameter("point", "m", 0, "A point of the plane."),
    vector_parameter("normal", "1", kRequired, "Direction towards the beads; its length does not matter."),
    number_parameter("size", "m", 1, 1e-3, 1e3, "Side of the square that pictures show; the plane itself has no end."),
    flag_parameter("round", false, "It is drawn as a disc of that diameter, not as a square; contact is endless all the same."),
};
constexpr Parameter kBoxParameters[] = {
    vector_parameter("low", "m", kRequired, "Corner with the smallest coordinates."),
    vector_parameter("high", "m", kRequired, "Corner with the largest coordinates."),
    text_parameter("open", "", "Faces that are left out, such as \"+y -z\"; the names are -x +x -y +y -z +z."),
};

constexpr Descriptor kCylinder = describe<geometry::CylinderPlugin>({
    .name = "cylinder",
    .version = "0.1.0",
    .doc = "The inside of a cylinder round z, with or without ends.",
    .equation = "delta = r + sqrt(x^2 + y^2) - R",
    .parameters = kCylinderParameters,
});
constexpr Descriptor kPlane = describe<geometry::Plane>({
    .name = "plane",
    .version = "0.1.0",
    .doc = "An endless plane.",
    .equation = "delta = r - n . (x - point)",
    .parameters = kPlaneParameters,
});
constexpr Descriptor kBox = describe<geometry::Box>({
    .name = "box",
    .version = "0.1.0",
    .doc = "The inside of an axis-aligned box; faces may be open. One material slot per closed face: x_low, x_high, …",
    .equation = "delta = r - |x - nearest point of the face|",
    .parameters = kBoxParameters,
});

}  // namespace

MILLSCOPE_PLUGINS(&kCylinder, &kPlane, &kBox)
