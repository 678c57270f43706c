#include "geometry/mesh/candidate_finder.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>

#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

// Entries of the grid below kFirstList; from there on they are places in lists_, shifted by it.
constexpr std::size_t kCellsAtOnce = 4096;  // FCL's objects for more would take more memory than all beads together
constexpr std::uint32_t kUnknown = 0, kFar = 1, kFirstList = 2;

fcl::Vector3d fcl_vector(const Point& p) { return {p.x, p.y, p.z}; }

/// A triangle or a cell, as FCL sees it. FCL hands back the CollisionObject: its index stands behind it.
struct Body : fcl::CollisionObject<double> {
  Body(const std::shared_ptr<fcl::CollisionGeometryd>& shape, std::uint32_t number) : CollisionObject<double>(shape), index(number) {}
  std::uint32_t index;
};

struct Found {
  std::uint32_t cell, triangle;
};

struct Collector {
  const Triangles* all;
  const std::vector<Point>* middles;
  double reach;
  std::vector<Found> found;
};

bool is_within(const Triangles& triangles, std::size_t index, const Point& p, double reach) {
  const double height = triangles.height(index, p);
  return std::fabs(height) <= reach && nearest_point(triangles, index, p, height, reach * reach).squared <= reach * reach;
}

/// Boxes overlap: keep the pair if the triangle really is that near.
bool collect(fcl::CollisionObjectd* sphere, fcl::CollisionObjectd* triangle, void* data) {
  Collector& c = *static_cast<Collector*>(data);
  const std::uint32_t cell = static_cast<Body*>(sphere)->index, index = static_cast<Body*>(triangle)->index;
  if (is_within(*c.all, index, (*c.middles)[cell], c.reach)) c.found.push_back({cell, index});
  return false;  // go on
}

}  // namespace

struct CandidateFinder::Trees {
  std::deque<Body> bodies;  // a deque does not move what it holds
  fcl::DynamicAABBTreeCollisionManagerd triangles;

  explicit Trees(const std::vector<TriangleRecord>& records) {
    std::vector<fcl::CollisionObjectd*> all;
    all.reserve(records.size());
    for (std::uint32_t t = 0; t < records.size(); ++t) {
      const TriangleRecord& r = records[t];
      bodies.emplace_back(std::make_shared<fcl::TrianglePd>(fcl_vector(r.a), fcl_vector(r.a + r.e), fcl_vector(r.a + r.f)), t);
      all.push_back(&bodies.back());
    }
    triangles.registerObjects(all);
    triangles.setup();
  }

  /// Pairs of a place and a triangle within `reach` of it, by place, then by triangle: the same whatever the trees look like.
  std::vector<Found> near_places(const Triangles& all_triangles, const std::vector<Point>& middles, double reach) {
    const auto sphere = std::make_shared<fcl::Sphered>(reach);
    std::deque<Body> cells;
    std::vector<fcl::CollisionObjectd*> all;
    for (const Point& p : middles) {
      Body& body = cells.emplace_back(sphere, static_cast<std::uint32_t>(cells.size()));
      body.setTranslation(fcl_vector(p));
      body.computeAABB();
      all.push_back(&body);
    }
    fcl::DynamicAABBTreeCollisionManagerd spheres;
    spheres.registerObjects(all);
    spheres.setup();
    Collector collector{&all_triangles, &middles, reach, {}};
    spheres.collide(&triangles, &collector, &collect);
    std::sort(collector.found.begin(), collector.found.end(),
              [](const Found& a, const Found& b) { return a.cell != b.cell ? a.cell < b.cell : a.triangle < b.triangle; });
    return std::move(collector.found);
  }
};

CandidateFinder::CandidateFinder(const Triangles& triangles) : triangles_(triangles), trees_(std::make_unique<Trees>(triangles.records)) {
  std::vector<Point> corners;
  for (const TriangleRecord& t : triangles.records) {
    for (const Point& p : {t.a, t.a + t.e, t.a + t.f}) corners.push_back(p);
  }
  box_ = bounds_of(corners);
}

CandidateFinder::~CandidateFinder() = default;

void CandidateFinder::prepare(double reach) {
  if (reach <= distance_) return;
  const double distance = 1.1 * reach;  // a little room, so that a growing margin does not empty the lists each time
  lists_.clear();
  grid_.prepare(box_, distance);
  distance_ = distance;
}

/// The beads that are not surely far; the cells that are not known yet.
void CandidateFinder::look_up(const GeometryBeads& beads, std::vector<NearBead>& near, std::vector<std::uint64_t>& unknown) const {
  near.clear();
  unknown.clear();
  constexpr std::int64_t kAtOnce = 64;  // beads whose entries come from memory side by side
  std::uint64_t cells[kAtOnce];
  for (std::int64_t first = 0; first < beads.count; first += kAtOnce) {
    const std::int64_t last = std::min(beads.count, first + kAtOnce);
    for (std::int64_t i = first; i < last; ++i) {
      cells[i - first] = grid_.cell_of({beads.position[0][i], beads.position[1][i], beads.position[2][i]});
      grid_.fetch(cells[i - first]);
    }
    for (std::int64_t i = first; i < last; ++i) {
      const std::uint64_t cell = cells[i - first];
      const std::uint32_t entry = cell == CellGrid::kOutside ? kFar : grid_.entry(cell);
      if (entry == kFar) continue;
      if (entry == kUnknown) unknown.push_back(cell);
      near.push_back({i, entry});
    }
  }
}

/// Cells that were unknown; another thread may have learnt some of them since.
void CandidateFinder::learn(std::vector<std::uint64_t>& unknown) {
  std::sort(unknown.begin(), unknown.end());
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  std::erase_if(unknown, [&](std::uint64_t cell) { return grid_.entry(cell) != kUnknown; });
  for (std::size_t begin = 0; begin < unknown.size(); begin += kCellsAtOnce) {
    resolve({unknown.data() + begin, std::min(kCellsAtOnce, unknown.size() - begin)});
  }
}

void CandidateFinder::resolve(std::span<const std::uint64_t> cells) {
  std::vector<Point> middles;
  for (const std::uint64_t cell : cells) middles.push_back(grid_.middle_of(cell));
  const std::vector<Found> found = trees_->near_places(triangles_, middles, distance_ + grid_.half_diagonal());
  if (lists_.size() + cells.size() + found.size() > 0xffff0000U)
    throw Refusal("mesh: the lists of near triangles exceed 16 GB: use a coarser mesh");
  std::size_t next = 0;
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    const std::size_t begin = next;
    while (next < found.size() && found[next].cell == c) ++next;
    grid_.entry(cells[c]) = next == begin ? kFar : static_cast<std::uint32_t>(lists_.size()) + kFirstList;
    if (next == begin) continue;
    lists_.push_back(static_cast<std::uint32_t>(next - begin));
    for (std::size_t i = begin; i < next; ++i) lists_.push_back(found[i].triangle);
  }
}

void CandidateFinder::send(const NearBead& near, const GeometryBeads& beads, double margin, const CandidateSink& sink) const {
  const std::int64_t i = near.bead;
  const Point p{beads.position[0][i], beads.position[1][i], beads.position[2][i]};
  const double reach = beads.radius[i] + margin;
  const std::uint32_t* list = &lists_[near.entry - kFirstList];
  for (std::uint32_t k = 1; k <= list[0]; ++k) {
    if (is_within(triangles_, list[k], p, reach)) sink.add(sink.host, i, list[k]);
  }
}

void CandidateFinder::find(const GeometryBeads& beads, double margin, const CandidateSink& sink) {
  double largest = 0;
  for (std::int64_t i = 0; i < beads.count; ++i) largest = std::max(largest, beads.radius[i]);
  const double reach = largest + margin;
  if (!std::isfinite(reach)) throw Refusal("mesh: a bead's radius or the list margin is not finite");
  std::vector<NearBead> near;
  std::vector<std::uint64_t> unknown;
  std::shared_lock reading(known_);
  for (;;) {
    const double distance = distance_;
    const bool ready = reach <= distance;
    if (ready) look_up(beads, near, unknown);
    if (ready && unknown.empty()) break;
    reading.unlock();
    {
      const std::unique_lock learning(known_);
      prepare(reach);
      if (ready && distance == distance_) learn(unknown);  // else another thread has made other cells
    }
    reading.lock();
  }
  for (const NearBead& bead : near) send(bead, beads, margin, sink);
}

}  // namespace millscope::geometry
