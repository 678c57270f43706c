#include "geometry/mesh/candidate_finder.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace millscope::geometry {

namespace {

/// The tree of beads is made anew when the number of beads has changed by more than this fraction since it was made.
constexpr double kDrift = 0.05;

fcl::Vector3d fcl_vector(const Point& p) { return {p.x, p.y, p.z}; }

/// A triangle or a bead, as FCL sees it. FCL hands back the CollisionObject: its index stands behind it.
struct Body : fcl::CollisionObjectd {
  Body(const std::shared_ptr<fcl::CollisionGeometryd>& shape, std::uint32_t number) : fcl::CollisionObject<double>(shape), index(number) {}
  std::uint32_t index;
};

struct NearBead {
  std::int64_t bead;
  Point position;
  double reach;
};

struct Found {
  std::uint32_t slot, triangle;
};

struct Collector {
  const std::vector<TriangleRecord>* records;
  const std::vector<NearBead>* beads;
  std::vector<Found>* found;
};

/// Boxes overlap: keep the pair if the bead really is that near.
bool collect(fcl::CollisionObjectd* sphere, fcl::CollisionObjectd* triangle, void* data) {
  const Collector& c = *static_cast<Collector*>(data);
  const std::uint32_t slot = static_cast<Body*>(sphere)->index, index = static_cast<Body*>(triangle)->index;
  const TriangleRecord& t = (*c.records)[index];
  const NearBead& bead = (*c.beads)[slot];
  const double height = height_above(t, bead.position);
  if (std::fabs(height) <= bead.reach && nearest_point(t, bead.position, height).squared <= bead.reach * bead.reach) {
    c.found->push_back({slot, index});
  }
  return false;  // go on
}

}  // namespace

struct CandidateFinder::Trees {
  std::deque<Body> triangle_bodies, bead_bodies;  // a deque does not move what it holds
  fcl::DynamicAABBTreeCollisionManagerd triangles, beads;
  std::size_t registered = 0, made_with = 0;
  std::vector<NearBead> near;
  std::vector<Found> found, sorted;
  std::vector<std::uint32_t> first;

  explicit Trees(const std::vector<TriangleRecord>& records) {
    std::vector<fcl::CollisionObjectd*> all;
    all.reserve(records.size());
    for (std::uint32_t t = 0; t < records.size(); ++t) {
      const TriangleRecord& r = records[t];
      triangle_bodies.emplace_back(std::make_shared<fcl::TrianglePd>(fcl_vector(r.a), fcl_vector(r.a + r.e), fcl_vector(r.a + r.f)), t);
      all.push_back(&triangle_bodies.back());
    }
    triangles.registerObjects(all);
    triangles.setup();
  }

  void place_beads();
  void register_beads();
  void sort_found();
};

/// One body per near bead: moved, and its sphere resized where the radius differs.
void CandidateFinder::Trees::place_beads() {
  while (bead_bodies.size() < near.size()) {
    bead_bodies.emplace_back(std::make_shared<fcl::Sphered>(1.0), static_cast<std::uint32_t>(bead_bodies.size()));
  }
  for (std::size_t slot = 0; slot < near.size(); ++slot) {
    Body& body = bead_bodies[slot];
    auto& sphere = const_cast<fcl::Sphered&>(static_cast<const fcl::Sphered&>(*body.collisionGeometry()));
    if (sphere.radius != near[slot].reach) {
      sphere.radius = near[slot].reach;
      sphere.computeLocalAABB();
    }
    body.setTranslation(fcl_vector(near[slot].position));
    body.computeAABB();
  }
}

void CandidateFinder::Trees::register_beads() {
  const auto change = std::fabs(static_cast<double>(near.size()) - static_cast<double>(made_with));
  if (registered == 0 || change > kDrift * static_cast<double>(made_with)) {
    std::vector<fcl::CollisionObjectd*> all;
    for (std::size_t slot = 0; slot < near.size(); ++slot) all.push_back(&bead_bodies[slot]);
    beads.clear();
    beads.registerObjects(all);
    made_with = near.size();
  } else {
    while (registered > near.size()) beads.unregisterObject(&bead_bodies[--registered]);
    while (registered < near.size()) beads.registerObject(&bead_bodies[registered++]);
  }
  registered = near.size();
  beads.update();
}

/// By bead, then by triangle: the same whatever the trees look like.
void CandidateFinder::Trees::sort_found() {
  first.assign(near.size() + 1, 0);
  for (const Found& f : found) ++first[f.slot + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  sorted.resize(found.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Found& f : found) sorted[next[f.slot]++] = f;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    std::sort(sorted.begin() + first[i], sorted.begin() + first[i + 1],
              [](const Found& a, const Found& b) { return a.triangle < b.triangle; });
  }
}

CandidateFinder::CandidateFinder(const std::vector<TriangleRecord>& records)
    : records_(records), trees_(std::make_unique<Trees>(records)) {}

CandidateFinder::~CandidateFinder() = default;

void CandidateFinder::find(const GeometryBeads& beads, double margin, const CandidateSink& sink) {
  Trees& trees = *trees_;
  double largest = 0;
  for (std::int64_t i = 0; i < beads.count; ++i) largest = std::max(largest, beads.radius[i]);
  grid_.prepare(records_, largest + margin);
  trees.near.clear();
  for (std::int64_t i = 0; i < beads.count; ++i) {
    const Point p{beads.position[0][i], beads.position[1][i], beads.position[2][i]};
    if (grid_.is_near(p.x, p.y, p.z)) trees.near.push_back({i, p, beads.radius[i] + margin});
  }
  trees.found.clear();
  if (trees.near.empty()) return;
  trees.place_beads();
  trees.register_beads();
  Collector collector{&records_, &trees.near, &trees.found};
  trees.beads.collide(&trees.triangles, &collector, &collect);
  trees.sort_found();
  for (const Found& f : trees.sorted) sink.add(sink.host, trees.near[f.slot].bead, f.triangle);
}

}  // namespace millscope::geometry
