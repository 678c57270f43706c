// From rows to points in time order. Every rule counts what it sets aside. For the files of this room.
#pragma once

#include <vector>

#include "studies/recording/recording.hpp"
#include "studies/recording/table.hpp"

namespace millscope::studies {

/// What is known of all runs together before points are judged by where they are; medians and percentiles, so outliers hardly matter.
struct Extent {
  std::array<double, 3> middle{};  ///< median, m
  std::array<double, 3> width{};   ///< from the 0.5th to the 99.5th percentile, m
  double largest() const;          ///< of the three widths
  double across() const;           ///< larger width of x and y: about the mill's diameter
};
Extent measure_extent(const std::vector<Run>& runs);

/// 99th percentile of the speed over five points, m/s; 0 where no run has six points.
double fast_speed(const std::vector<Run>& runs);

/// Rows in the order of the file → one run, or several where the clock was set back for good. Sorts, and sets aside false times and
/// duplicates. `report` is that of the rows.
std::vector<Run> order_rows(Rows rows, const RunReport& report);

/// Sets aside points farther than `reach` in x, y or z from the middle.
void drop_outside(Run& run, const Extent& extent, double reach);

/// Sets aside points that no bead of at most `speed` (m/s) can reach from their neighbours and leave again. `noise`: of a component, m.
void drop_outliers(Run& run, double speed, double noise);

/// Ten median intervals between points, at least 10 ms and at most 0.1 s, but never less than three median intervals; s.
double default_gap_limit(const std::vector<Run>& runs);

/// Fills gaps and gap_time of the report.
void count_gaps(Run& run, double gap_limit);

}  // namespace millscope::studies
