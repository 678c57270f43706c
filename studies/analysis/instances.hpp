// Which analyzers a run has, and with which parameters.
//
//   # analysis.yaml
//   analyzers:
//     pept_grid: {cells_x: 40}              # the name of a plugin …
//     fine: {kind: pept_grid, cells_x: 100} # … or a name of one's own with its kind
#pragma once

#include <string>
#include <vector>

#include "kernel/config/document.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/objects.hpp"

namespace millscope::studies {

/// One analyzer with its parameters; what it needs has been checked.
struct AnalyzerInstance {
  std::string name;
  host::AnalyzerObject object;
  config::ResolvedValues values;
};

struct AnalyzerChoice {
  std::vector<AnalyzerInstance> instances;  ///< in the order of their names
  std::vector<std::string> left_out;        ///< "name: why"
};

/// The analyzers of `settings` (its map `analyzers`), or, where it has none, one of every plugin with its defaults. `only`: names of
/// instances or plugins to take; empty: all. What was asked for by name and cannot work is a UserError; what was not is left out with
/// the reason. `chosen_in_settings`: the settings' own file makes the choice; names that only overrides mention do not.
AnalyzerChoice choose_analyzers(const config::Node& settings, bool chosen_in_settings, const std::vector<std::string>& only,
                                const host::Registry& registry, const AnalyzerContext& context);

/// Fields of FrameField as words, for messages: "velocity, spin".
std::string field_names(std::uint64_t fields);

}  // namespace millscope::studies
