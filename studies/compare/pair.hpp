// Which result of A goes with which of B, and what stands in the way.
#pragma once

#include <string>
#include <vector>

#include "studies/compare/compare.hpp"

namespace millscope::compare {

struct ResultPair {
  std::size_t a, b;  ///< indices of arrays
};

/// Whether a pair says how much data there are, or how sure something is: it differs between any two results of unequal length.
bool is_bookkeeping(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair);

/// Pairs results of the same analyzer and name. `alone` receives those that only one has, and those over times that one
/// has more of. Throws base::UserError for other units, shapes
/// or axes, with the remedy; not for bookkeeping.
std::vector<ResultPair> pair_results(const analysis::ResultSet& a, const analysis::ResultSet& b, const CompareOptions& options,
                                     std::vector<std::string>& alone);

/// Sentences on conditions that differ: speed, mill, kind of source, options of analyzers.
std::vector<std::string> condition_notes(const analysis::ResultSet& a, const analysis::ResultSet& b);

}  // namespace millscope::compare
