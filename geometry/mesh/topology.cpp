#include "geometry/mesh/topology.hpp"

#include <algorithm>
#include <numeric>

namespace millscope::geometry {

namespace {

struct Edge {
  std::uint32_t low, high;  // vertices
  std::uint32_t triangle;
  std::uint32_t corner;  // the edge runs from this corner to the next
};

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);  // the root is the first triangle of the set
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<Edge> sorted_edges(const IndexedMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return edges;
}

/// Direction within the triangle, away from the edge and across it: independent of how the triangle is wound.
Point away(const IndexedMesh& mesh, const Edge& e) {
  const Point a = mesh.vertices[e.low], along = mesh.vertices[e.high] - a, to = mesh.vertex(e.triangle, (e.corner + 2) % 3) - a;
  const Point across = to - (dot(to, along) / dot(along, along)) * along;
  return (1 / length(across)) * across;
}

bool is_smooth(const IndexedMesh& mesh, const Edge& a, const Edge& b) { return -dot(away(mesh, a), away(mesh, b)) > kSmoothCosine; }

std::uint32_t number_sets(Sets& sets, std::vector<std::uint32_t>& number) {
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < number.size(); ++t) {
    const std::uint32_t root = sets.root(t);
    number[t] = root == t ? count++ : number[root];  // a root comes before its members
  }
  return count;
}

void count_edge(const IndexedMesh& mesh, const std::vector<Edge>& edges, std::size_t begin, std::size_t end, Topology& out) {
  if (edges[begin].triangle >= mesh.own) return;  // of periodic copies only
  if (end - begin == 1) {
    ++out.open_edges;
  } else if (end - begin > 2) {
    ++out.crowded_edges;
  } else {
    ++out.shared_edges;
    const auto starts_low = [&](const Edge& e) { return mesh.triangles[e.triangle][e.corner] == e.low; };
    out.turned_edges += starts_low(edges[begin]) == starts_low(edges[begin + 1]);
  }
}

}  // namespace

Topology find_topology(const IndexedMesh& mesh) {
  Topology out;
  const std::vector<Edge> edges = sorted_edges(mesh);
  Sets patches(mesh.triangles.size()), parts(mesh.triangles.size());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    count_edge(mesh, edges, begin, end, out);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        parts.join(edges[i].triangle, edges[j].triangle);
        if (is_smooth(mesh, edges[i], edges[j])) patches.join(edges[i].triangle, edges[j].triangle);
      }
    }
  }
  out.patch.resize(mesh.triangles.size());
  out.parts = number_sets(parts, out.patch);
  out.patches = number_sets(patches, out.patch);
  return out;
}

}  // namespace millscope::geometry
