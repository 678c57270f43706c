// From rows to points in time order. Every rule counts what it sets aside. For the files of this room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kernel/base/error.hpp"
#include "studies/recording/recording.hpp"
#include "studies/recording/table.hpp"
#include "studies/recording/travel.hpp"

namespace millscope::recording {

/// The rows of each label as a run of its own, named after it, in the order of `Table::labels`; those of -1, which trackers give to what is
/// no bead's, are set aside as lost. One run where there are no labels, one, or so many that they number rows.
std::vector<Run> runs_of_labels(Table table, const std::vector<std::string>& wanted, const base::Location& where);

/// Sets aside, in the order of the file, rows in which the tracker says that it has no place: one place over and over (zeros, −1, 999), or
/// the last one repeated to the last digit while the bead moves.
void drop_lost(Run& rows);

/// Throws base::UserError for rows, in the order of the file, that no single bead can have: of two that take turns, or at random places.
void refuse_several(const Run& rows, const std::filesystem::path& file);

/// Rows of one time stay in the order of the file. Counts those that ran backwards.
void sort_by_time(Run& run);

/// Counts rows that belong to no run as lost ones of this run.
void carry_lost(Run& run, std::uint64_t rows);

/// Rows in the order of the file → one run, or several where the clock was set back for good. Sorts, and sets aside false times and
/// duplicates.
std::vector<Run> order_rows(Run rows);

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
