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

/// What a bead in these runs can do: one and a half times the speed of a fall across the mill, or of the 95th percentile of the measured
/// speeds and a half where that is more.
struct Travel {
  double speed = 0;  ///< m/s
  double noise = 0;  ///< m, of a component
  /// Whether it can get from point i to the later point j. The noise of two points in three components is allowed for sevenfold.
  bool possible(const Run& run, std::size_t i, std::size_t j) const;
};
Travel measure_travel(std::span<const Run> runs, double gap_limit);

}  // namespace millscope::recording
