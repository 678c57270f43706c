#include "studies/engine/liggghts/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "kernel/base/vector3.hpp"

namespace millscope::engine::liggghts {
namespace {

using base::Vector3;

constexpr double kJoinedAnyway = 0.256235;  // degrees: of LIGGGHTS itself
constexpr double kSame = 1e-9;              // m: vertices nearer than this are one
constexpr double kMargin = 0.9;

Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector3 scaled(double factor, const Vector3& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
double length(const Vector3& a) { return std::sqrt(base::dot(a, a)); }
double degrees(double cosine) { return 180 / std::numbers::pi * std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// Triangles over vertices of which no two are at one place.
class Welded {
 public:
  Welded(const Surface& surface, const std::vector<std::uint32_t>& corners) {
    std::map<std::array<std::int64_t, 3>, std::uint32_t> numbers;
    for (const std::uint32_t corner : corners) {
      Vector3 place{};
      std::array<std::int64_t, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) place[k] = surface.vertices[3 * corner + k], key[k] = std::llround(place[k] / kSame);
      const auto [at, is_new] = numbers.emplace(key, static_cast<std::uint32_t>(places.size()));
      if (is_new) places.push_back(place);
      vertices.push_back(at->second);
    }
  }
  std::vector<Vector3> places;
  std::vector<std::uint32_t> vertices;  ///< 3 for each triangle
};

struct Edge {
  std::uint32_t low, high;
  auto operator<=>(const Edge&) const = default;
};

/// Directions within the triangles of each edge, across it and away from it.
std::map<Edge, std::vector<Vector3>> away_from_edges(const Welded& mesh) {
  std::map<Edge, std::vector<Vector3>> all;
  for (std::size_t t = 0; t + 2 < mesh.vertices.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.vertices[t + k], b = mesh.vertices[t + (k + 1) % 3], c = mesh.vertices[t + (k + 2) % 3];
      const Vector3 along = minus(mesh.places[b], mesh.places[a]), to = minus(mesh.places[c], mesh.places[a]);
      const Vector3 across = minus(to, scaled(base::dot(to, along) / base::dot(along, along), along));
      if (length(across) > 0) all[{std::min(a, b), std::max(a, b)}].push_back(scaled(1 / length(across), across));
    }
  }
  return all;
}

/// From a place to the axis of a motion.
Vector3 to_axis(const Vector3& place, const dem::Motion& motion) {
  const Vector3 arm = minus({motion.point[0], motion.point[1], motion.point[2]}, place),
                axis{motion.axis[0], motion.axis[1], motion.axis[2]};
  return minus(arm, scaled(base::dot(arm, axis), axis));
}

/// Collects turns that LIGGGHTS must not join.
class Smallest {
 public:
  void take(double turn) {
    if (turn > kJoinedAnyway) smallest_ = std::min(smallest_, kMargin * turn);
  }
  double value() const { return std::max(smallest_, kJoinedAnyway); }

 private:
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

double smooth_degrees(const Surface& surface, const std::vector<std::uint32_t>& corners, const dem::Motion& motion) {
  const Welded mesh(surface, corners);
  Smallest smallest;
  std::map<std::uint32_t, std::vector<Vector3>> sharp;  // directions of sharp ridges, away from each vertex
  for (const auto& [edge, away] : away_from_edges(mesh)) {
    if (away.size() != 2) continue;
    const Vector3 &low = mesh.places[edge.low], &high = mesh.places[edge.high];
    const double turn = 180 - degrees(base::dot(away[0], away[1]));
    const Vector3 inward = to_axis(scaled(0.5, {low[0] + high[0], low[1] + high[1], low[2] + high[2]}), motion);
    if (base::dot(away[0], inward) + base::dot(away[1], inward) >= 0) continue;  // hollow
    if (turn < kSmoothDegrees) {
      smallest.take(turn);
      continue;
    }
    const Vector3 along = scaled(1 / length(minus(high, low)), minus(high, low));
    sharp[edge.low].push_back(along);
    sharp[edge.high].push_back(scaled(-1, along));
  }
  for (const auto& [vertex, edges] : sharp) {
    if (edges.size() == 2) smallest.take(180 - degrees(base::dot(edges[0], edges[1])));
  }
  return smallest.value();
}

}  // namespace millscope::engine::liggghts
