// The joint covariance of a run's results, read off their common draws. For the files of this room.
#pragma once

#include "studies/analysis/results.hpp"

namespace millscope::analysis {

inline constexpr std::size_t kLongestCovarianceRow = 64;

/// Fills entries, covariance and rank from the draws. The diagonal is near sem², which is widened for each value's own memory.
void add_covariance(ResultSet& results);

}  // namespace millscope::analysis
