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

/// Reads post/ of `folder` and makes the folder `out`: case.resolved.yaml, frames.h5 (where the case has frames), series.csv, summary.json;
/// whole or not at all. What LIGGGHTS does not give is absent. Throws base::UserError for what is missing, cut short or of another case,
/// and for beads that were lost.
Imported import_case(const std::filesystem::path& folder, const std::filesystem::path& out, const host::Registry& registry,
                     const std::vector<std::string>& command_line);

}  // namespace millscope::engine::liggghts
