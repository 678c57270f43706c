#include "studies/engine/liggghts/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "kernel/base/vector3.hpp"

namespace millscope::engine::liggghts {
namespace {

using base::Vector3;

constexpr double kMargin = 0.9;
constexpr double kOuterPart = 0.7;  // of the radius: nearer to the axis a wall may be met from behind, as a shaft is
constexpr double kSame = 1e-6;      // of the radius, and of a unit vector

Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector3 scaled(double factor, const Vector3& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
double length(const Vector3& a) { return std::sqrt(base::dot(a, a)); }
Vector3 unit(const Vector3& a) { return scaled(1 / length(a), a); }
double degrees(double cosine) { return 180 / std::numbers::pi * std::acos(std::clamp(cosine, -1.0, 1.0)); }

struct Edge {
  std::uint32_t low, high;
  auto operator<=>(const Edge&) const = default;
};

/// The edges of a wall and what its beads' side is told by.
class Wall {
 public:
  Wall(const Surface& surface, const Interior& inside, const std::vector<std::uint32_t>& corners) : surface_(surface), inside_(inside) {
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      for (std::size_t k = 0; k < 3; ++k) add(corners[t + k], corners[t + (k + 1) % 3], corners[t + (k + 2) % 3]);
    }
    for (std::uint64_t c = 0; c < 3 * surface.triangle_count; ++c) {  // of all materials
      const double at = along(place(surface.triangles[c]));
      low_ = std::min(low_, at), high_ = std::max(high_, at);
    }
  }

  /// The smallest turn and angle that must not be joined, degrees; kSmoothDegrees at most.
  double smallest() {
    for (const auto& [edge, away] : away_) take_edge(edge, away);
    for (const auto& [vertex, open] : open_) {
      const bool in_line = open.size() == 2 && 180 - degrees(base::dot(open[0], open[1])) <= kJoinedAnyway;
      if (open.size() > 1 && !in_line) take_corner(vertex);
    }
    return smallest_;
  }

 private:
  Vector3 place(std::uint32_t v) const { return {surface_.vertices[3 * v], surface_.vertices[3 * v + 1], surface_.vertices[3 * v + 2]}; }
  double along(const Vector3& p) const { return base::dot(p, {inside_.axis[0], inside_.axis[1], inside_.axis[2]}); }
  Vector3 to_axis(const Vector3& p) const {
    const Vector3 arm = minus({inside_.axis_point[0], inside_.axis_point[1], inside_.axis_point[2]}, p);
    const Vector3 axis{inside_.axis[0], inside_.axis[1], inside_.axis[2]};
    return minus(arm, scaled(base::dot(arm, axis), axis));
  }

  /// The direction within a triangle across its edge a–b and away from it.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vector3 edge = minus(place(b), place(a)), to = minus(place(c), place(a));
    const Vector3 across = minus(to, scaled(base::dot(to, edge) / base::dot(edge, edge), edge));
    if (length(across) > 0) away_[{std::min(a, b), std::max(a, b)}].push_back(unit(across));
    neighbours_[a].insert(b), neighbours_[b].insert(a);
  }

  void take(double angle) {
    if (angle > kJoinedAnyway) smallest_ = std::min(smallest_, kMargin * angle);
  }

  bool at_an_end(const Edge& edge) const {
    const double slack = kSame * inside_.radius, a = along(place(edge.low)), b = along(place(edge.high));
    return std::max(a, b) <= low_ + slack || std::min(a, b) >= high_ - slack;
  }

  bool is_hollow(const Edge& edge, const std::vector<Vector3>& away) const {
    const Vector3 low = place(edge.low), high = place(edge.high);
    const Vector3 inward = to_axis(scaled(0.5, {low[0] + high[0], low[1] + high[1], low[2] + high[2]}));
    if (length(inward) < kOuterPart * inside_.radius) return false;
    return std::all_of(away.begin(), away.end(), [&](const Vector3& a) { return base::dot(a, unit(inward)) > -kSame; });
  }

  void take_edge(const Edge& edge, const std::vector<Vector3>& away) {
    const bool is_free = away.size() == 1;
    if (at_an_end(edge) || (!is_free && is_hollow(edge, away))) return;
    const double turn = is_free ? 180 : 180 - degrees(base::dot(away[0], away[1]));
    take(turn);
    if (turn <= kJoinedAnyway) return;
    const Vector3 direction = unit(minus(place(edge.high), place(edge.low)));
    open_[edge.low].push_back(direction);
    open_[edge.high].push_back(scaled(-1, direction));
  }

  void take_corner(std::uint32_t vertex) {
    std::vector<Vector3> edges;
    for (const std::uint32_t other : neighbours_.at(vertex)) edges.push_back(unit(minus(place(other), place(vertex))));
    for (std::size_t a = 0; a < edges.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double angle = degrees(base::dot(edges[a], edges[b]));
        take(std::min(angle, 180 - angle));
      }
    }
  }

  const Surface& surface_;
  const Interior& inside_;
  std::map<Edge, std::vector<Vector3>> away_;  ///< of each edge, one for each of its triangles
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbours_;
  std::map<std::uint32_t, std::vector<Vector3>> open_;  ///< of each vertex: edges in the open that leave it
  double low_ = std::numeric_limits<double>::max(), high_ = std::numeric_limits<double>::lowest();  ///< m, along the axis
  double smallest_ = kSmoothDegrees;
};

}  // namespace

std::vector<MeshFile> meshes_of(const run::Assembly& a) {
  std::vector<MeshFile> all;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const run::GeometryUse& use = a.geometries[g];
    const std::size_t first = all.size();
    for (std::size_t slot = 0; slot < use.slots.size(); ++slot) {
      const int type = a.index_of_material(a.c.geometry[g].material_of(use.slots[slot])) + 1;
      const auto same =
          std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(), [&](const MeshFile& m) { return m.type == type; });
      if (same == all.end())
        all.push_back(
            {fmt::format("wall{}", all.size()), fmt::format("meshes/wall{}.stl", all.size()), g, type, {static_cast<std::uint32_t>(slot)}});
      else
        same->slots.push_back(static_cast<std::uint32_t>(slot));
    }
  }
  return all;
}

std::vector<std::uint32_t> corners_of(const run::Assembly& a, const MeshFile& mesh) {
  const Surface& all = a.geometries[mesh.body].surface;
  std::vector<std::uint32_t> corners;
  for (std::uint64_t t = 0; t < all.triangle_count; ++t) {
    const std::uint32_t slot = all.triangle_materials == nullptr ? 0 : all.triangle_materials[t];
    if (std::find(mesh.slots.begin(), mesh.slots.end(), slot) == mesh.slots.end()) continue;
    corners.insert(corners.end(), all.triangles + 3 * t, all.triangles + 3 * t + 3);
  }
  return corners;
}

double smooth_degrees(const Surface& surface, const Interior& inside, const std::vector<std::uint32_t>& corners) {
  if (inside.is_cylinder == 0) return kJoinedAnyway;
  return std::max(kJoinedAnyway, Wall(surface, inside, corners).smallest());
}

}  // namespace millscope::engine::liggghts
