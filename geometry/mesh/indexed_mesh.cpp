#include "geometry/mesh/indexed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "millscope/layout.hpp"

namespace millscope::geometry {

namespace {

/// Vertices in a hash of cells of eight tolerances: a point asks only the cells that its tolerance reaches, mostly one.
class Welder {
 public:
  Welder(IndexedMesh& mesh, std::size_t expected) : mesh_(mesh), cell_(8 * mesh.weld), next_() { cells_.reserve(expected); }

  std::uint32_t weld(const Point& p) {
    const double x[3] = {p.x, p.y, p.z};
    std::int64_t low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = static_cast<std::int64_t>(std::floor((x[k] - mesh_.weld) / cell_));
      high[k] = static_cast<std::int64_t>(std::floor((x[k] + mesh_.weld) / cell_));
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const std::uint32_t found = find(key(i, j, k), p);
          if (found != kNone) return found;
        }
      }
    }
    return insert(p);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    return hash_numbers({static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(k)});
  }

  std::uint32_t find(std::uint64_t cell, const Point& p) const {
    const auto head = cells_.find(cell);
    for (std::uint32_t v = head == cells_.end() ? kNone : head->second; v != kNone; v = next_[v]) {
      if (length(mesh_.vertices[v] - p) <= mesh_.weld) return v;
    }
    return kNone;
  }

  std::uint32_t insert(const Point& p) {
    const auto index = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(p);
    const auto cell = [this](double x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
    const auto [head, fresh] = cells_.try_emplace(key(cell(p.x), cell(p.y), cell(p.z)), kNone);
    next_.push_back(head->second);
    head->second = index;
    return index;
  }

  IndexedMesh& mesh_;
  double cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
  std::vector<std::uint32_t> next_;  // next vertex of the same cell
};

struct CornersHash {
  std::size_t operator()(const Corners& c) const { return hash_numbers({c[0], c[1], c[2]}); }
};

/// A sliver lower than the tolerance has no direction worth having.
bool is_degenerate(const Point& a, const Point& b, const Point& c, double tolerance) {
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  return !(length(cross(b - a, c - a)) > longest * tolerance);
}

class Indexer {
 public:
  Indexer(IndexedMesh& mesh, std::size_t expected) : mesh_(mesh), welder_(mesh, expected / 2 + 16) { seen_.reserve(expected); }

  /// False: the triangle was dropped.
  bool add(const Point (&p)[3], std::uint32_t slot, std::uint32_t source, bool count) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = welder_.weld(p[k]);
    const bool collapsed = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    if (collapsed || is_degenerate(mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]], mesh_.weld)) {
      mesh_.degenerate += count;
      return false;
    }
    Corners sorted = c;
    std::sort(sorted.begin(), sorted.end());
    if (!seen_.insert(sorted).second) {
      mesh_.duplicate += count;
      return false;
    }
    mesh_.triangles.push_back(c);
    mesh_.slots.push_back(slot);
    mesh_.source.push_back(source);
    return true;
  }

 private:
  IndexedMesh& mesh_;
  Welder welder_;
  std::unordered_set<Corners, CornersHash> seen_;
};

void add_periodic_copies(IndexedMesh& mesh, Indexer& indexer, const Bounds& box, double period) {
  for (std::uint32_t t = 0; t < mesh.own; ++t) {
    const Point corner[3] = {mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2)};
    const double low = std::min({corner[0].z, corner[1].z, corner[2].z}), high = std::max({corner[0].z, corner[1].z, corner[2].z});
    const bool near_low = low - box.low.z < 0.5 * period, near_high = box.high.z - high < 0.5 * period;
    for (const double shift : {near_low ? period : 0.0, near_high ? -period : 0.0}) {
      if (shift == 0) continue;
      const Point step{0, 0, shift};
      indexer.add({corner[0] + step, corner[1] + step, corner[2] + step}, mesh.slots[t], t, false);
    }
  }
}

}  // namespace

IndexedMesh index_mesh(const Soup& soup, double period) {
  IndexedMesh mesh;
  const Bounds box = bounds_of(soup.corners);
  mesh.weld = kWeldFraction * box.diagonal();
  if (!(mesh.weld > 0)) {
    mesh.degenerate = soup.size();
    return mesh;
  }
  mesh.triangles.reserve(soup.size());
  Indexer indexer(mesh, soup.size());
  for (std::size_t t = 0; t < soup.size(); ++t) {
    const auto next = static_cast<std::uint32_t>(mesh.triangles.size());
    indexer.add({soup.corners[3 * t], soup.corners[3 * t + 1], soup.corners[3 * t + 2]}, soup.slots[t], next, true);
  }
  mesh.own = mesh.triangles.size();
  if (period > 0) add_periodic_copies(mesh, indexer, box, period);
  return mesh;
}

}  // namespace millscope::geometry
