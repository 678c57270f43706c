// A run from its case to its output directory, and its continuation.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"

namespace millscope::run {

struct RunOptions {
  std::filesystem::path output;
  std::vector<std::string> overrides;     ///< --set
  std::vector<std::string> command_line;  ///< for the provenance
  int threads = 0;
  bool force = false;  ///< overwrite an earlier run
  bool quiet = false;
  bool terminal = false;  ///< one progress line that is rewritten, else plain log lines
  std::string instruction_set;
};

/// How a run ended.
enum class Outcome { finished, interrupted };

/// Runs a case from its start. Where a bead runs away before `analyze_from_s` the run begins again with half the time step, at most twice:
/// what damping allows where many beads touch is less than what one contact does (docs/cases.md). Throws UserError.
Outcome run_case(const std::string& case_file, const host::Registry& registry, const RunOptions& options);

/// Continues from the newest checkpoint of `options.output`; `overrides` may change time.end_s, time.analyze_from_s and run.threads
/// only. Throws UserError.
Outcome resume_run(const host::Registry& registry, const RunOptions& options);

/// Asks the current run to write a checkpoint and stop (SIGINT, SIGTERM); safe in a signal handler.
void request_stop();
bool is_stop_requested();

/// What `millscope check` predicts.
struct Estimate {
  std::uint64_t beads = 0;
  double time_step = 0, rayleigh_fraction = 0, contact_steps = 0;
  std::int64_t steps = 0;
  int partitions = 1;
  double wall_seconds = 0;  ///< from a short trial of the very case
  std::uint64_t memory_bytes = 0, disk_bytes = 0;
  double particle_steps_per_s = 0;
};
Estimate estimate(const std::string& case_file, const host::Registry& registry, const RunOptions& options);

}  // namespace millscope::run
