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

namespace millscope::analysis {

/// An analyzer as settings ask for it. Nothing of the settings' document is needed any more, whose reading marks what was read: several
/// sources may be analysed at once.
struct AskedAnalyzer {
  std::string name;
  const host::Loaded* plugin = nullptr;
  config::ResolvedValues values;
  base::Location where;
  bool by_name = false;  ///< the user asked for it
  std::string refused;   ///< why it cannot be had, whatever the source; "" of all that were asked for by name
};

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

/// What `choose_analyzers` chooses from, in the order of the names. Throws UserError for what was asked for by name and cannot be had.
std::vector<AskedAnalyzer> read_analyzers(const config::Node& settings, bool chosen_in_settings, const std::vector<std::string>& only,
                                          const host::Registry& registry);
/// Those of them that the source serves. May be called by several threads. Throws UserError for what was asked for by name and the source
/// does not serve, and where nothing is left.
AnalyzerChoice create_analyzers(const std::vector<AskedAnalyzer>& asked, const AnalyzerContext& context);

/// Both at once: the analyzers of `settings` (its map `analyzers`), or, where it has none, one of every plugin with its defaults. `only`:
/// names of instances or plugins to take; empty: all. What was asked for by name and cannot work is a UserError; what was not is left out
/// with the reason. `chosen_in_settings`: the settings' own file makes the choice; names that only overrides mention do not.
AnalyzerChoice choose_analyzers(const config::Node& settings, bool chosen_in_settings, const std::vector<std::string>& only,
                                const host::Registry& registry, const AnalyzerContext& context);

/// Fields of FrameField as words, for messages: "velocity, spin".
std::string field_names(std::uint64_t fields);

}  // namespace millscope::analysis
