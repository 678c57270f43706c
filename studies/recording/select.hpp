// Choosing points of a run.
#pragma once

#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::recording {

/// Keeps the points with a mark that is not 0, in all arrays of the run; returns how many went. report.used follows.
std::uint64_t keep_only(Run& run, const std::vector<char>& keep);

/// Puts the points into the order given: new point i is the old point order[i], in all arrays of the run.
void reorder(Run& run, const std::vector<std::size_t>& order);

/// The points with these numbers, in this order; name and counts are not theirs.
Run chosen(const Run& run, const std::vector<std::size_t>& points);

/// Between the points i and j, m.
double distance(const Run& run, std::size_t i, std::size_t j);

}  // namespace millscope::recording
