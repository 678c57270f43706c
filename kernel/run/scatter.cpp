#include "kernel/run/scatter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernel/run/sphere_cells.hpp"

namespace millscope::run {
namespace {

constexpr std::size_t kBatch = 4096;       // points that are held against the walls at once
constexpr double kFirstShare = 0.22;       // solid volume of the part that is filled first: random addition is still quick there
constexpr std::size_t kTries = 400;        // vain tries in a row before the part grows …
constexpr std::size_t kLastTries = 40000;  // … and before giving up, when the part is all there is

/// Random points of the region for spheres of one radius, clear of the walls.
class Points {
 public:
  Points(const Assembly& a, const Region& r, Random& random) : a_(a), r_(r), random_(random) {}
  /// `part`: share of the region's height.
  base::Vector3 next(double radius, double part) {
    while (free_.empty()) fill(radius, part);
    const base::Vector3 p = free_.back();
    free_.pop_back();
    return p;
  }
  void forget() { free_.clear(); }

 private:
  void fill(double radius, double part) {
    const double top = level(a_, r_, part);
    std::vector<base::Vector3> points(kBatch);
    for (base::Vector3& p : points) p = draw(radius, top);
    const std::vector<std::uint8_t> bad = blocked(a_, points, radius * (1 + 1e-6));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!bad[i]) free_.push_back(points[i]);
    }
    if (free_.empty() && ++vain_ > 200) {
      throw base::UserError(a_.c.fill.where,
                            "no place is clear of the walls; check the liner's unit and orientation (millscope geometry report)");
    }
  }
  base::Vector3 draw(double radius, double top) {
    for (;;) {
      base::Vector3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double margin = a_.c.domain.periodic[axis] ? 0 : radius;
        const double low = r_.box.low[axis] + margin, high = r_.box.high[axis] - margin;
        p[axis] = low + (high - low) * random_.uniform();
      }
      if (height(a_, p) > top) continue;
      if (r_.cylinder && std::hypot(p[0] - r_.axis_point[0], p[1] - r_.axis_point[1]) > r_.radius - radius) continue;
      return p;
    }
  }

  const Assembly& a_;
  const Region& r_;
  Random& random_;
  std::vector<base::Vector3> free_;
  int vain_ = 0;
};

}  // namespace

std::vector<base::Vector3> scattered(const Assembly& a, const Region& region, const std::vector<BeadType>& types, Random& random,
                                     const std::vector<Sphere>& occupied) {
  std::vector<std::size_t> order(types.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&types](std::size_t p, std::size_t q) { return types[p].diameter > types[q].diameter; });
  double solid = 0;
  for (const BeadType& t : types) solid += std::numbers::pi / 6 * t.diameter * t.diameter * t.diameter;
  double widest = types[order.front()].diameter;
  for (const Sphere& s : occupied) {
    solid += std::numbers::pi / 6 * std::pow(2 * s.radius, 3);
    widest = std::max(widest, 2 * s.radius);
  }
  double part = first_part(a, region, solid / kFirstShare);
  SphereCells cells(a, region, widest);
  for (const Sphere& s : occupied) cells.add(s);
  Points points(a, region, random);
  std::vector<base::Vector3> centres(types.size());
  for (std::size_t done = 0; done < order.size(); ++done) {
    const double radius = 0.5 * types[order[done]].diameter;
    for (std::size_t tries = 1;; ++tries) {
      const base::Vector3 p = points.next(radius, part);
      if (!cells.overlapping({p, radius * (1 + 1e-6)})) {
        cells.add({p, radius});
        centres[order[done]] = p;
        break;
      }
      if (part < 1 && tries % kTries == 0) {
        part = std::min(1.0, 1.15 * part);
        points.forget();
      }
      if (part >= 1 && tries > kLastTries) {
        throw base::UserError(
            a.c.fill.where,
            fmt::format("{} beads are asked for but only {} fit without touching, neither on a lattice of the largest bead's "
                        "size nor at random; lower the filling, or check that the liner is in the right unit (millscope "
                        "geometry report)",
                        types.size(), done));
      }
    }
  }
  return centres;
}

}  // namespace millscope::run
