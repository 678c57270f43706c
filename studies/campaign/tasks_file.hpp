// TASKS.yaml: a list of simulations; campaign.csv: what became of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "studies/campaign/campaign.hpp"

namespace millscope::campaign {

/// Reads
///
///     schema_version: 1
///     case: demo.yaml                            # of all that name none of their own; relative to this file
///     set: [time.end_s=1]                        # as --set, for all
///     simulations:
///       slow: {set: [mill.speed=50 %critical]}   # after those for all
///       wet:  {case: wet.yaml}
///
/// Throws UserError.
std::vector<Simulation> read_tasks(const std::string& file);

/// Header and one row each: label,key,state,wall_s,cached,folder,message. `known[i]`: whether outcomes[i] is; else the state is open.
void write_table(const std::filesystem::path& file, std::span<const Simulation> simulations, std::span<const Outcome> outcomes,
                 const std::vector<bool>& known);

}  // namespace millscope::campaign
