#include "kernel/run/scatter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace millscope::run {
namespace {

constexpr std::size_t kBatch = 4096;       // points that are held against the walls at once
constexpr double kFirstShare = 0.22;       // solid volume of the part that is filled first: random addition is still quick there
constexpr std::size_t kTries = 400;        // vain tries in a row before the part grows …
constexpr std::size_t kLastTries = 40000;  // … and before giving up, when the part is all there is

/// Beads by the cubic cell of their centre. Cells are no smaller than the largest bead, so that neighbours touch at most.
class Cells {
 public:
  Cells(const Assembly& a, const Region& r, double diameter) : low_(r.box.low) {
    double volume = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) volume *= r.box.high[axis] - r.box.low[axis];
    const double size = std::max(diameter, std::cbrt(volume / 4e6));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent_[axis] = r.box.high[axis] - r.box.low[axis];
      periodic_[axis] = a.c.domain.periodic[axis];
      count_[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(extent_[axis] / size));
    }
    cells_.resize(count_[0] * count_[1] * count_[2]);
  }

  bool is_free(const base::Vector3& p, double radius) const {
    std::array<std::int64_t, 3> home{}, from{}, to{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      home[axis] = cell(p, axis);
      // With fewer than three cells along a periodic axis each is looked at once.
      const bool all = periodic_[axis] && count_[axis] < 3;
      from[axis] = all ? 0 : periodic_[axis] ? home[axis] - 1 : std::max<std::int64_t>(0, home[axis] - 1);
      to[axis] = all ? count_[axis] - 1 : periodic_[axis] ? home[axis] + 1 : std::min(count_[axis] - 1, home[axis] + 1);
    }
    for (std::int64_t x = from[0]; x <= to[0]; ++x) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        for (std::int64_t z = from[2]; z <= to[2]; ++z) {
          for (const Sphere& s : cells_[index({x, y, z})]) {
            if (distance2(p, s.centre) < (radius + s.radius) * (radius + s.radius)) return false;
          }
        }
      }
    }
    return true;
  }

  void add(const base::Vector3& p, double radius) { cells_[index({cell(p, 0), cell(p, 1), cell(p, 2)})].push_back({p, radius}); }

 private:
  std::int64_t cell(const base::Vector3& p, std::size_t axis) const {
    const auto at = static_cast<std::int64_t>((p[axis] - low_[axis]) / extent_[axis] * static_cast<double>(count_[axis]));
    return std::clamp<std::int64_t>(at, 0, count_[axis] - 1);
  }
  std::size_t index(std::array<std::int64_t, 3> at) const {
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = (at[axis] + count_[axis]) % count_[axis];
    return (at[0] * count_[1] + at[1]) * count_[2] + at[2];
  }
  double distance2(const base::Vector3& p, const base::Vector3& q) const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double d = p[axis] - q[axis];
      if (periodic_[axis]) d -= extent_[axis] * std::round(d / extent_[axis]);
      sum += d * d;
    }
    return sum;
  }

  base::Vector3 low_;
  std::array<double, 3> extent_{};
  std::array<bool, 3> periodic_{};
  std::array<std::int64_t, 3> count_{};
  std::vector<std::vector<Sphere>> cells_;
};

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
  Cells cells(a, region, widest);
  for (const Sphere& s : occupied) cells.add(s.centre, s.radius);
  Points points(a, region, random);
  std::vector<base::Vector3> centres(types.size());
  for (std::size_t done = 0; done < order.size(); ++done) {
    const double radius = 0.5 * types[order[done]].diameter;
    for (std::size_t tries = 1;; ++tries) {
      const base::Vector3 p = points.next(radius, part);
      if (cells.is_free(p, radius * (1 + 1e-6))) {
        cells.add(p, radius);
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
