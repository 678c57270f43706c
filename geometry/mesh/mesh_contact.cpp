#include "geometry/mesh/mesh_contact.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/mesh/topology.hpp"

#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

/// Distances closer than this fraction of the bead's radius are equal: rounding leaves about 1e-15.
constexpr double kEqualFraction = 1e-11;
/// Hits kept per bead; beyond it the farthest goes. A bead on triangles a tenth of its overlap's width has about fifty.
constexpr int kMaxHits = 64;
/// The second contact on a patch gets this added to its feature, the third twice this.
constexpr std::uint32_t kFeatureStep = 1U << 28;

/// Corners (0, 1, 2) that a region names: one for a vertex, two for an edge.
struct Places {
  int count;
  std::size_t corner[2];
};
constexpr Places kPlaces[7] = {{0, {0, 0}}, {2, {0, 1}}, {2, {1, 2}}, {2, {2, 0}}, {1, {0, 0}}, {1, {1, 1}}, {1, {2, 2}}};

int rank(Region r) { return is_face(r) ? 0 : is_vertex(r) ? 2 : 1; }

}  // namespace

struct MeshContact::Hit {
  Point to_bead;
  double distance;
  std::uint32_t record;
  Region region;
};

struct MeshContact::Hits {
  Hit item[kMaxHits];
  int count = 0;
  double equal = 0;

  void add(const Hit& hit) {
    if (count < kMaxHits) {
      item[count++] = hit;
      return;
    }
    Hit* farthest = std::max_element(item, item + count, [](const Hit& a, const Hit& b) { return a.distance < b.distance; });
    if (hit.distance < farthest->distance) *farthest = hit;
  }

  /// Nearest first; insertion, since there are rarely more than three.
  void sort() {
    for (int i = 1; i < count; ++i) {
      const Hit hit = item[i];
      int j = i;
      for (; j > 0 && comes_before(hit, item[j - 1]); --j) item[j] = item[j - 1];
      item[j] = hit;
    }
  }
  static bool comes_before(const Hit& a, const Hit& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.record < b.record);
  }

  /// `other` explains a place that both contain.
  bool is_nearer(const Hit& other, const Hit& hit) const {
    if (other.distance < hit.distance - equal) return true;
    if (other.distance > hit.distance + equal) return false;
    const int mine = rank(hit.region), theirs = rank(other.region);
    return theirs < mine || (theirs == mine && other.record < hit.record);
  }
};

const TriangleRecord& MeshContact::record(const Hit& hit) const { return triangles_.records[hit.record]; }

void MeshContact::collect(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, Hits& hits) const {
  const double limit = bead.radius + bead.reach, limit_squared = limit * limit;
  for (std::size_t i = 0; i < count; ++i) {
    const double height = triangles_.height(candidates[i], bead.position);
    if (std::fabs(height) >= limit) continue;
    const Nearest nearest = nearest_point(triangles_, candidates[i], bead.position, height, limit_squared);
    if (nearest.squared >= limit_squared) continue;
    hits.add({nearest.to_bead, std::sqrt(nearest.squared), candidates[i], nearest.region});
  }
}

/// Whether the triangle of `other` contains the place of `hit`, which is on an edge or vertex.
bool MeshContact::contains(const Hit& other, const Hit& hit, const Point& centre) const {
  const TriangleRecord& mine = record(hit);
  const TriangleRecord& theirs = record(other);
  const Places& places = element(kPlaces, hit.region);
  int shared = 0;
  for (int k = 0; k < places.count; ++k) {
    const std::uint32_t vertex = mine.vertex[places.corner[k]];
    shared += vertex == theirs.vertex[0] || vertex == theirs.vertex[1] || vertex == theirs.vertex[2];
  }
  if (shared == places.count) return true;
  const Point place = centre - hit.to_bead;
  const double height = triangles_.height(other.record, place);
  return std::fabs(height) <= weld_ && nearest_point(triangles_, other.record, place, height, weld_ * weld_).squared <= weld_ * weld_;
}

bool MeshContact::is_real(const Hits& hits, int i, const Point& centre) const {
  const Hit& hit = hits.item[i];
  if (is_face(hit.region)) return true;
  for (int j = 0; j < hits.count; ++j) {
    if (j != i && hits.is_nearer(hits.item[j], hit) && contains(hits.item[j], hit, centre)) return false;
  }
  return true;
}

void MeshContact::report(const WallBead& bead, const Hits& hits, WallContacts& out) const {
  const Hit* kept[kMaxWallContacts];
  int count = 0;
  for (int i = 0; i < hits.count && count < kMaxWallContacts; ++i) {
    const Hit& hit = hits.item[i];
    if (hits.count > 1 && !is_real(hits, i, bead.position)) continue;
    bool merged = false;
    for (int k = 0; k < count && !merged; ++k) {
      const bool joins = (is_face(hit.region) && is_face(kept[k]->region)) || record(hit).patch == record(*kept[k]).patch;
      merged = joins && dot(hit.to_bead, kept[k]->to_bead) > kSmoothCosine * hit.distance * kept[k]->distance;
    }
    if (!merged) kept[count++] = &hit;
  }
  for (int i = 0; i < count; ++i) {
    const Hit& hit = *kept[i];
    const TriangleRecord& t = record(hit);
    std::uint32_t feature = t.patch;
    for (int k = 0; k < count; ++k) {  // in the order of their triangles, so that the numbers do not change places from step to step
      if (record(*kept[k]).patch == t.patch && kept[k]->record < hit.record) feature += kFeatureStep;
    }
    // A centre on the surface itself has no direction of its own: the triangle's.
    const Point normal = hit.distance > 0 ? (1 / hit.distance) * hit.to_bead : triangles_.planes[hit.record].normal;
    out.add({bead.radius - hit.distance, normal, feature, t.source, t.slot});
  }
}

void MeshContact::touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const {
  Hits hits;
  collect(bead, candidates, count, hits);
  if (hits.count == 0) return;
  hits.equal = kEqualFraction * bead.radius;
  if (hits.count > 1) hits.sort();
  report(bead, hits, out);
}

}  // namespace millscope::geometry
