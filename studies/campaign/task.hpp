// One simulation of the cache, carried out in this process: what a head's child and a Slurm task do.
#pragma once

#include <filesystem>

#include "kernel/host/registry.hpp"

namespace millscope::campaign {

inline constexpr int kInterruptedCode = 3;  ///< of a simulation that was stopped and can be resumed

/// Exit codes of `campaign-task` besides the program's own: 0 done, 2 failed and recorded, 3 stopped, 4 the disk is full.
inline constexpr int kBusy = 75;  ///< another process writes this run

/// Runs CACHE/<key> from its start or its checkpoint with one thread, and says in task.json what became of it. Returns the exit code.
/// SIGINT and SIGTERM: a checkpoint is written first.
int perform(const std::filesystem::path& entry_folder, const host::RegistryOptions& plugins);

}  // namespace millscope::campaign
