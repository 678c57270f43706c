// What charge_features adds up, and how to read it: a map in x and y, a polar map about the mill's axis, heights, flights.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/centre.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

/// The additive arrays, in this order.
enum FieldArray { kMap, kPockets, kPolar, kHeights, kLaunches, kLandings, kEndBands, kTotals, kFieldArrays };

/// Per cell of the map. The last two stand only for the beads whose flights are looked for.
enum MapMoment { kCellTime, kCellVx, kCellVy, kCellSpeed, kCellWatched, kCellFlight, kMapMoments };
/// Per cell of the polar map: time, outward velocity, velocity in the turning sense.
enum PolarMoment { kPolarTime, kOutward, kAround, kPolarMoments };
/// Per bin of height: time and x.
enum HeightMoment { kHeightTime, kHeightX, kHeightMoments };
/// Of lifter pockets and end bands.
enum ShareMoment { kShareTime, kShareSpeed, kShareMoments };
enum Total { kTotalTime, kTotalX, kTotalY, kTotalOutside, kTotals_ };

/// Geometry of the fields; the same for all blocks.
struct FieldShape {
  double radius;     ///< of the bare shell, m
  double reach;      ///< largest radius of a bead's centre, m
  double sense;      ///< of turning, ±1
  double omega;      ///< |Ω|, rad/s
  Bins cells;        ///< along x and along y, m
  Bins angles;       ///< rad from 6 o'clock in the turning sense, −π … π
  Bins rings;        ///< m
  Bins heights;      ///< along y, m
  double lifters;    ///< height of the lifters, m; 0: unknown
  double end_bands;  ///< m at each end face; 0: unknown or none

  /// rad from 6 o'clock, positive in the turning sense.
  double angle(double x, double y) const { return angle_of(sense * x, -y); }
};

/// Sums, read by name.
class ChargeFields {
 public:
  ChargeFields(const FieldShape& shape, const double* const* sums) : shape_(&shape), sums_(sums) {}

  const FieldShape& shape() const { return *shape_; }
  const double* cell(std::int64_t ix, std::int64_t iy) const { return sums_[kMap] + kMapMoments * (iy * shape_->cells.count + ix); }
  const double* polar(std::int64_t angle, std::int64_t ring) const {
    return sums_[kPolar] + kPolarMoments * (angle * shape_->rings.count + ring);
  }
  const double* height(std::int64_t bin) const { return sums_[kHeights] + kHeightMoments * bin; }
  FlowMap flow() const { return {shape_->cells, sums_[kMap], kMapMoments, shape_->radius, shape_->sense}; }
  const double* array(FieldArray name) const { return sums_[name]; }
  double total(Total what) const { return sums_[kTotals][what]; }

 private:
  const FieldShape* shape_;
  const double* const* sums_;
};

/// Place where a histogram over `bins`, taken as a density, has the fraction `part` of its sum below it; NaN when it is empty.
inline double quantile(const std::vector<double>& histogram, const Bins& bins, double part) {
  double sum = 0;
  for (const double h : histogram) sum += h;
  if (!(sum > 0)) return kNaN;
  double below = 0;
  for (std::int64_t i = 0; i < bins.count; ++i) {
    const double here = element(histogram, i);
    if (below + here >= part * sum && here > 0) return bins.edge(i) + bins.width() * (part * sum - below) / here;
    below += here;
  }
  return bins.high;
}

}  // namespace millscope::analyzers
