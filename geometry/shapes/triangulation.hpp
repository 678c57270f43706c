// Triangles of an analytic shape: for pictures, per-triangle work and export. Contact never uses them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "millscope/geometry.hpp"
#include "millscope/pack.hpp"

namespace millscope::geometry {

using Point = Vec<double>;

class Triangulation {
 public:
  std::uint32_t add_vertex(const Point& p) {
    for (const double x : {p.x, p.y, p.z}) vertices_.push_back(x);
    return static_cast<std::uint32_t>(vertices_.size() / 3 - 1);
  }

  /// Counter-clockwise seen from the beads' side. A triangle that uses a vertex twice is left out.
  void add_triangle(const std::array<std::uint32_t, 3>& corner, std::uint32_t material) {
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) return;
    for (const std::uint32_t c : corner) triangles_.push_back(c);
    materials_.push_back(material);
  }

  std::size_t triangle_count() const { return materials_.size(); }

  Surface view() const { return {vertices_.size() / 3, vertices_.data(), materials_.size(), triangles_.data(), materials_.data()}; }

 private:
  std::vector<double> vertices_;
  std::vector<std::uint32_t> triangles_, materials_;
};

/// "key: value" lines common to the analytic shapes.
std::string shape_report(const std::string& kind, const Surface& surface, const std::string& details);

}  // namespace millscope::geometry
