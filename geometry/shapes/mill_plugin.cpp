// The plugin library `mill`.
#include <numbers>

#include "geometry/shapes/mill.hpp"

namespace {

using namespace millscope;

constexpr const char* kStudy = "Chagas 2015, laboratory mill";
constexpr Parameter kParameters[] = {
    number_parameter("diameter", "m", kRequired, 0.005, 50, "Inner diameter of the bare shell."),
    number_parameter("length", "m", kRequired, 1e-4, 50, "Inner length, from z = 0; the period of a slice."),
    integer_parameter("lifters", 0, 0, 1000, "Number of lifters, evenly spaced; 0: smooth shell."),
    number_parameter("lifter_height", "m", 0, 0, 5, "Height of a lifter: the top lies at radius R − height.", kStudy),
    number_parameter("lifter_width", "m", 0, 0, 10, "Width of a lifter at its base, on the tangent of the shell.", kStudy),
    number_parameter("lifter_face_angle", "rad", std::numbers::pi / 3, 0.35, std::numbers::pi / 2,
                     "Angle between the face of a lifter and its base; below 0.35 rad (20 deg) face and shell are one smooth surface.",
                     kStudy),
    number_parameter("phase", "rad", 0, -100, 100, "Angle of the middle of the first lifter from the x axis, counter-clockwise."),
    flag_parameter("end_faces", false, "Flat walls at z = 0 and z = length; false: the wall goes on along z, as a periodic slice needs."),
    number_parameter("facet", "m", 0.003, 1e-5, 10, "Longest chord of the triangles for pictures and export; contact is exact anyway."),
    integer_parameter("axial_cuts", 1, 1, 1000, "Rows of triangles along z (resolution of the maps of wear)."),
};

constexpr Descriptor kMill = describe<geometry::MillPlugin>({
    .name = "mill",
    .version = "0.1.0",
    .doc = "Parametric mill: circular shell, trapezoid lifters, flat ends; exact contact.",
    .equation = "delta = r - |x - nearest point of shell, lifter face, lifter top or top corner|",
    .parameters = kParameters,
});

}  // namespace

MILLSCOPE_PLUGINS(&kMill)
