// What LIGGGHTS leaves in the folder of an exported case, as files of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"

namespace millscope::engine::liggghts {

struct Imported {
  std::size_t beads = 0, frames = 0;
  double until = 0;  ///< s, of the case's own time
};

/// How the results came about; 0: not known.
struct HowRun {
  std::vector<std::string> command_line;
  int ranks = 0;
  double wall = 0;  ///< s
};

/// Reads post/ of `folder` into `out`, which is there: case.resolved.yaml, frames.h5 (where the case has frames), series.csv, and last of
/// all summary.json. Throws as `import_case`.
Imported read_results(const std::filesystem::path& folder, const std::filesystem::path& out, const host::Registry& registry,
                      const HowRun& how);

/// Reads post/ of `folder` and makes the folder `out` with its results, whole or not at all. What LIGGGHTS does not give is absent. Throws
/// base::UserError for what is missing, cut short or of another case, and for beads that were lost.
Imported import_case(const std::filesystem::path& folder, const std::filesystem::path& out, const host::Registry& registry,
                     const std::vector<std::string>& command_line);

}  // namespace millscope::engine::liggghts
