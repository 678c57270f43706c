#include "studies/campaign/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/output/summary.hpp"

namespace millscope::campaign {
namespace {

/// Some limits are the most that may be, others the least.
double excess(const run::Doubt& doubt) { return std::abs(std::log(doubt.value / doubt.limit)); }

void add(const run::Doubt& doubt, std::vector<SharedDoubt>& shared) {
  const auto known = std::find_if(shared.begin(), shared.end(),
                                  [&](const SharedDoubt& s) { return s.worst.name == doubt.name && s.worst.of == doubt.of; });
  if (known == shared.end()) {
    shared.push_back({doubt, 1, 0});
    return;
  }
  ++known->said_by;
  if (excess(doubt) > excess(known->worst)) known->worst = doubt;
}

}  // namespace

std::vector<SharedDoubt> shared_doubts(const std::set<std::filesystem::path>& runs) {
  std::vector<SharedDoubt> shared;
  std::size_t simulations = 0;
  for (const std::filesystem::path& run : runs) {
    if (run.empty()) continue;  // no folder came of it: not the working directory
    const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
    if (!summary.is_object()) continue;
    ++simulations;
    for (const run::Doubt& doubt : run::doubts_in(summary)) add(doubt, shared);
  }
  for (SharedDoubt& s : shared) s.simulations = simulations;
  return shared;
}

std::string sentence_of(const SharedDoubt& doubt) {
  return fmt::format("{} of {} simulations{}: {}", doubt.said_by, doubt.simulations, doubt.said_by > 1 ? ", the worst" : "",
                     run::sentence_of(doubt.worst));
}

nlohmann::ordered_json doubts_json(const std::vector<SharedDoubt>& doubts) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SharedDoubt& doubt : doubts) {
    list.push_back(doubt.worst);
    list.back()["said_by"] = doubt.said_by;
    list.back()["simulations"] = doubt.simulations;
  }
  return list;
}

}  // namespace millscope::campaign
