// LIGGGHTS at work: a case from its start to the files of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kernel/host/registry.hpp"
#include "kernel/run/simulation.hpp"

namespace millscope::engine::liggghts {

/// Exports the case into OUT/engine, lets LIGGGHTS run it there on run.ranks processes (through mpirun where there are more
/// than one) and reads the results into OUT. Interrupted: OUT/engine is kept, and there are no results. Throws base::UserError where
/// LIGGGHTS is not installed or another version, where it cannot play the case, and with what it said where it stopped.
run::Outcome play_case(const std::string& case_file, const host::Registry& registry, const run::RunOptions& options);

/// Lets a run that was stopped or killed go on from its newest sound restart file, from its start where it has none. Bits differ from those
/// of a run in one go; no time is missing. Throws base::UserError, also for a run that is finished.
run::Outcome resume_case(const host::Registry& registry, const run::RunOptions& options);

/// The newest restart file in the folder of a case that LIGGGHTS plays, which may be half written; "": none.
std::filesystem::path newest_restart(const std::filesystem::path& folder);

/// The first line that LIGGGHTS prints. Throws base::UserError where it is not installed, or is not version 3.8.
std::string installed_version();

/// Ranks along x, y, z. A drum is long: slices along z first, none thinner than four of the largest beads, then cuts along x through the
/// bed; none along y, where the upper half would be empty.
struct RankGrid {
  int x = 1, y = 1, z = 1;
  bool operator==(const RankGrid&) const = default;
};
RankGrid rank_grid(int ranks, double length, double largest_diameter);

/// Of a log of LIGGGHTS as far as it is written: the last step that it tells, or nothing; the first line with an error, or "".
struct LogState {
  std::optional<std::int64_t> step;
  std::string error;
};
LogState state_of_log(const std::string& text);

}  // namespace millscope::engine::liggghts
