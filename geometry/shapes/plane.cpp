#include "geometry/shapes/plane.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace millscope::geometry {

namespace {

Point unit_normal(const Parameters& parameters) {
  const double* n = parameters.vector("normal");
  const double size = length(Point{n[0], n[1], n[2]});
  if (!(size > 0) || !std::isfinite(size))
    throw Refusal("plane: normal [0, 0, 0] has no direction: give for example [0, 1, 0], towards the beads");
  return (1 / size) * Point{n[0], n[1], n[2]};
}

/// What there is to look at: a disc or a square across the normal, of that diameter or side.
void draw(Triangulation& triangles, const Point& point, const Point& normal, double size, bool round) {
  constexpr int kCorners = 64;
  const Point helper = std::fabs(normal.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point across = cross(normal, helper), a = (0.5 * size / length(across)) * across, b = cross(normal, a);
  std::vector<std::uint32_t> corners;
  for (int i = 0; i < (round ? kCorners : 4); ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    const double s = round ? std::cos(angle) : i == 0 || i == 3 ? -1 : 1, t = round ? std::sin(angle) : i < 2 ? -1 : 1;
    corners.push_back(triangles.add_vertex(point + s * a + t * b));
  }
  for (std::size_t i = 2; i < corners.size(); ++i) triangles.add_triangle({corners[0], corners[i - 1], corners[i]}, 0);
}

}  // namespace

Plane::Plane(const Parameters& parameters) : normal_(unit_normal(parameters)) {
  const double* p = parameters.vector("point");
  const Point point{p[0], p[1], p[2]};
  offset_ = dot(normal_, point);
  draw(triangles_, point, normal_, parameters.number("size"), parameters.flag("round"));
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
