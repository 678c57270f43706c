#include "geometry/shapes/triangulation.hpp"

#include <algorithm>
#include <cstdio>

namespace millscope::geometry {

namespace {

Point vertex(const Surface& s, std::uint32_t i) { return {s.vertices[3 * i], s.vertices[3 * i + 1], s.vertices[3 * i + 2]}; }

}  // namespace

std::string shape_report(const std::string& kind, const Surface& s, const std::string& details) {
  double area = 0, low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    const Point a = vertex(s, s.triangles[3 * t]);
    area += 0.5 * length(cross(vertex(s, s.triangles[3 * t + 1]) - a, vertex(s, s.triangles[3 * t + 2]) - a));
  }
  for (std::uint64_t i = 0; i < 3 * s.vertex_count; ++i) {
    const auto axis = i % 3;
    low[axis] = i < 3 ? s.vertices[i] : std::min(low[axis], s.vertices[i]);
    high[axis] = i < 3 ? s.vertices[i] : std::max(high[axis], s.vertices[i]);
  }
  char text[512];
  std::snprintf(text, sizeof text,
                "kind: %s (contact is analytic; the triangles serve pictures and export)\ntriangles: %llu\n"
                "box: [%.6g, %.6g, %.6g] to [%.6g, %.6g, %.6g] m\narea: %.6g m^2\n",
                kind.c_str(), static_cast<unsigned long long>(s.triangle_count), low[0], low[1], low[2], high[0], high[1], high[2], area);
  return text + details;
}

}  // namespace millscope::geometry
