// From rows to points in time order. Every rule counts what it sets aside. For the files of this room.
#pragma once

#include <vector>

#include "studies/recording/recording.hpp"
#include "studies/recording/table.hpp"
#include "studies/recording/travel.hpp"

namespace millscope::recording {

/// Rows in the order of the file → one run, or several where the clock was set back for good. Sorts, and sets aside false times and
/// duplicates. `report` is that of the rows.
std::vector<Run> order_rows(Rows rows, const RunReport& report);

/// Sets aside points outside the ranges of x, y and z, m.
void drop_outside(Run& run, const std::array<std::array<double, 2>, 3>& range);

/// Sets aside points that the bead cannot reach from their neighbours and leave again.
void drop_outliers(Run& run, const Travel& travel);

/// Between consecutive points, s; 0 where there are none.
double median_interval(const std::vector<Run>& runs);

/// Ten median intervals between points, at least 10 ms and at most 0.1 s, but never less than three median intervals; s.
double default_gap_limit(const std::vector<Run>& runs);

/// Fills gaps and gap_time of the report.
void count_gaps(Run& run, double gap_limit);

}  // namespace millscope::recording
