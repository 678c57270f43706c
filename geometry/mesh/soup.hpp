// Triangles as a file gives them: three corners each, no shared vertices yet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "millscope/pack.hpp"

namespace millscope::geometry {

using Point = Vec<double>;

struct Soup {
  std::vector<Point> corners;        ///< 3 per triangle, m once the unit is applied
  std::vector<std::uint32_t> slots;  ///< material slot of each triangle
  std::vector<std::string> names;    ///< of the slots: the names of the solids, or "all"
  std::vector<std::string> notes;    ///< of the reader, for the report

  std::size_t size() const { return slots.size(); }
};

struct Bounds {
  Point low{0, 0, 0}, high{0, 0, 0};
  Point extent() const { return high - low; }
  double diagonal() const { return length(high - low); }
};

inline Bounds bounds_of(const std::vector<Point>& points) {
  if (points.empty()) return {};
  Bounds b{points[0], points[0]};
  for (const Point& p : points) {
    b.low = {minimum(b.low.x, p.x), minimum(b.low.y, p.y), minimum(b.low.z, p.z)};
    b.high = {maximum(b.high.x, p.x), maximum(b.high.y, p.y), maximum(b.high.z, p.z)};
  }
  return b;
}

}  // namespace millscope::geometry
