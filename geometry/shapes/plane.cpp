#include "geometry/shapes/plane.hpp"

#include <cmath>
#include <cstdio>

namespace millscope::geometry {

namespace {

Point unit_normal(const Parameters& parameters) {
  const double* n = parameters.vector("normal");
  const double size = length(Point{n[0], n[1], n[2]});
  if (!(size > 0) || !std::isfinite(size))
    throw Refusal("plane: normal [0, 0, 0] has no direction: give for example [0, 1, 0], towards the beads");
  return (1 / size) * Point{n[0], n[1], n[2]};
}

}  // namespace

Plane::Plane(const Parameters& parameters) : normal_(unit_normal(parameters)) {
  const double* p = parameters.vector("point");
  const Point point{p[0], p[1], p[2]};
  offset_ = dot(normal_, point);
  // A square to look at.
  const Point helper = std::fabs(normal_.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point across = cross(normal_, helper), a = (0.5 * parameters.number("size") / length(across)) * across, b = cross(normal_, a);
  const std::uint32_t corner[4] = {triangles_.add_vertex(point - a - b), triangles_.add_vertex(point + a - b),
                                   triangles_.add_vertex(point + a + b), triangles_.add_vertex(point - a + b)};
  triangles_.add_triangle({corner[0], corner[1], corner[2]}, 0);
  triangles_.add_triangle({corner[0], corner[2], corner[3]}, 0);
  char text[160];
  std::snprintf(text, sizeof text, "plane: normal [%.6g, %.6g, %.6g], n·x = %.6g m, endless\n", normal_.x, normal_.y, normal_.z, offset_);
  report_ = shape_report("plane", surface(), text);
}

void Plane::candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const {
  for (std::int64_t i = 0; i < beads.count; ++i) {
    const Point p{beads.position[0][i], beads.position[1][i], beads.position[2][i]};
    if (dot(normal_, p) - offset_ < beads.radius[i] + margin) sink.add(sink.host, i, 0);
  }
}

void Plane::touch(const WallBead& bead, const std::uint32_t*, std::size_t, WallContacts& out) const {
  out.add({bead.radius - (dot(normal_, bead.position) - offset_), normal_, 0, kNoTriangle, 0});
}

}  // namespace millscope::geometry
