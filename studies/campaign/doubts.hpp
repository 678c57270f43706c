// What many simulations give cause to doubt, each doubt once.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "kernel/run/doubts.hpp"

namespace millscope::campaign {

/// A doubt that several simulations share.
struct SharedDoubt {
  run::Doubt worst;             ///< where the value is farthest beyond the limit
  std::size_t said_by = 0;      ///< simulations
  std::size_t simulations = 0;  ///< of so many
};

/// The doubts of the runs' summaries, in the order in which they are first met. An empty path, and what has no summary, is no simulation.
std::vector<SharedDoubt> shared_doubts(const std::set<std::filesystem::path>& runs);

/// "12 of 48 simulations: …", the worst of them.
std::string sentence_of(const SharedDoubt& doubt);

/// As `summary.json` has them, with `said_by` and `simulations`.
nlohmann::ordered_json doubts_json(const std::vector<SharedDoubt>& doubts);

}  // namespace millscope::campaign
