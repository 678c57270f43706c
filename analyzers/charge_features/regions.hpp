// Regions of the charge as labels of the map's cells, and what share of its time each takes.
//
// label              cell
// 1 en masse         mean flow turns with the mill about its axis: carried up by the shell
// 2 cascading layer  mean flow turns against it: falls over the bed
// 3 cataracting      more than half of the time is free flight
// 4 eye              within 0.15 R of the centre of circulation, mean flow below 20 % of the shell's speed
// 5 lifter pocket    below the lifters' height above the shell; told per sample, not per cell
// 0                  nothing was seen
//
// A cell has the first label that fits of 3, 4, 1, 2. On the map cells show 5 where beads lay between the lifters.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "analyzers/charge_features/fields.hpp"
#include "analyzers/common/centre.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

enum Region { kNothing, kEnMasse, kCascading, kCataracting, kEye, kPocket, kRegions };

/// Whether beads were seen there, between the lifters.
inline bool in_pocket(const ChargeFields& fields, double x, double y) {
  const FieldShape& shape = fields.shape();
  const double r = std::hypot(x, y);
  const std::optional<std::int64_t> ring = shape.rings.at(r);
  return shape.lifters > 0 && r > shape.radius - shape.lifters && ring.has_value() &&
         fields.polar(*shape.angles.at(shape.angle(x, y)), *ring)[kPolarTime] > 0;
}

/// Labels of all cells, row by row along y.
inline std::vector<Region> label_regions(const ChargeFields& fields, const std::optional<Centre>& centre) {
  const FieldShape& shape = fields.shape();
  const Bins& cells = shape.cells;
  const std::int64_t n = cells.count;
  std::vector<Region> labels(as_size(n * n), kNothing);
  const auto label = [&](std::int64_t ix, std::int64_t iy) -> Region& { return element(labels, iy * n + ix); };
  for (std::int64_t iy = 0; iy < n; ++iy) {
    for (std::int64_t ix = 0; ix < n; ++ix) {
      const double* cell = fields.cell(ix, iy);
      if (in_pocket(fields, cells.centre(ix), cells.centre(iy))) label(ix, iy) = kPocket;
      if (!(cell[kCellTime] > 0)) continue;
      const double around = shape.sense * (cells.centre(ix) * cell[kCellVy] - cells.centre(iy) * cell[kCellVx]);
      label(ix, iy) = cell[kCellFlight] > 0.5 * cell[kCellWatched] ? kCataracting : around > 0 ? kEnMasse : kCascading;
    }
  }
  if (!centre) return labels;

  constexpr double kSlow = 0.2, kReach = 0.15;
  for (std::int64_t iy = 0; iy < n; ++iy) {
    for (std::int64_t ix = 0; ix < n; ++ix) {
      const double* cell = fields.cell(ix, iy);
      if (label(ix, iy) != kEnMasse && label(ix, iy) != kCascading) continue;
      if (std::hypot(cells.centre(ix) - centre->x, cells.centre(iy) - centre->y) > kReach * shape.radius) continue;
      if (std::hypot(cell[kCellVx], cell[kCellVy]) < kSlow * shape.omega * shape.radius * cell[kCellTime]) label(ix, iy) = kEye;
    }
  }
  return labels;
}

struct RegionSums {
  double time = 0, speed = 0;  ///< s; m
  double vx = 0, vy = 0;       ///< m
};

/// Sums over the cells of each region; pockets from their own array.
inline std::vector<RegionSums> sum_regions(const ChargeFields& fields, const std::vector<Region>& labels) {
  std::vector<RegionSums> regions(kRegions);
  const Bins& cells = fields.shape().cells;
  for (std::int64_t iy = 0; iy < cells.count; ++iy) {
    for (std::int64_t ix = 0; ix < cells.count; ++ix) {
      const double* cell = fields.cell(ix, iy);
      RegionSums& region = element(regions, element(labels, iy * cells.count + ix));
      region.time += cell[kCellTime];
      region.speed += cell[kCellSpeed];
    }
  }
  regions[kPocket].time += fields.array(kPockets)[kShareTime];
  regions[kPocket].speed += fields.array(kPockets)[kShareSpeed];
  return regions;
}

/// Angle of the free surface from the horizontal, rad: direction of the mean flow of the cascading layer within 30° (about the axis) of the
/// centre of circulation, where the layer runs along the bed's surface.
inline double surface_angle(const ChargeFields& fields, const std::vector<Region>& labels, const Centre& centre) {
  const FieldShape& shape = fields.shape();
  const Bins& cells = shape.cells;
  const double middle = shape.angle(centre.x, centre.y);
  double vx = 0, vy = 0;
  for (std::int64_t iy = 0; iy < cells.count; ++iy) {
    for (std::int64_t ix = 0; ix < cells.count; ++ix) {
      if (element(labels, iy * cells.count + ix) != kCascading) continue;
      if (std::fabs(std::remainder(shape.angle(cells.centre(ix), cells.centre(iy)) - middle, 2 * std::numbers::pi)) > std::numbers::pi / 6)
        continue;
      vx += fields.cell(ix, iy)[kCellVx];
      vy += fields.cell(ix, iy)[kCellVy];
    }
  }
  return vx == 0 && vy == 0 ? kNaN : std::atan2(-vy, -shape.sense * vx);
}

}  // namespace millscope::analyzers
