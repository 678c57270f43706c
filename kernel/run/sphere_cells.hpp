// Spheres by the cell in which they lie, to ask what a further one would touch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/run/scatter.hpp"

namespace millscope::run {

/// Beads by the cubic cell of their centre. Cells are no smaller than the largest bead, so that neighbours touch at most.
class SphereCells {
 public:
  SphereCells(const Assembly& a, const Region& r, double diameter) : low_(r.box.low) {
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

  /// The number, in the order of adding, of a sphere into which this one sinks by more than `depth` of the smaller radius.
  std::optional<std::size_t> overlapping(const Sphere& sphere, double depth = 0) const {
    const base::Vector3& p = sphere.centre;
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
          for (const auto& [s, number] : cells_[index({x, y, z})]) {
            const double least = sphere.radius + s.radius - depth * std::min(sphere.radius, s.radius);
            if (distance2(p, s.centre) < least * least) return number;
          }
        }
      }
    }
    return std::nullopt;
  }

  void add(const Sphere& s) { cells_[index({cell(s.centre, 0), cell(s.centre, 1), cell(s.centre, 2)})].emplace_back(s, count_all_++); }

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
  std::vector<std::vector<std::pair<Sphere, std::size_t>>> cells_;
  std::size_t count_all_ = 0;
};

}  // namespace millscope::run
