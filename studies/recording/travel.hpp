// How far a bead can get between two points. For the files of this room and of the trajectory.
#pragma once

#include <array>
#include <span>

#include "studies/recording/recording.hpp"

namespace millscope::recording {

/// Where the points of some runs lie: medians and percentiles, so outliers hardly matter.
struct Extent {
  std::array<double, 3> middle{};  ///< median, m
  std::array<double, 3> width{};   ///< from the 2nd to the 98th percentile, m
  double largest() const;          ///< of the three widths
  double across() const;           ///< larger width of x and y: about the mill's diameter
};
Extent measure_extent(std::span<const Run> runs);

/// The speed over five points that the part `fraction` of the points does not exceed, m/s; 0 where no run has six points.
double speed_quantile(std::span<const Run> runs, double fraction);

/// √(2 g D): the speed of a fall across the mill, m/s.
double fall_speed(double diameter);

Travel measure_travel(std::span<const Run> runs, double gap_limit);

}  // namespace millscope::recording
