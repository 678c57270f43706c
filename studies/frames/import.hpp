// Frames of another simulation program as the directory of a run: what analyze, compare and report take.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"

namespace millscope::frames {

struct Imported {
  std::size_t beads = 0, frames = 0, tracks = 0;
  double from = 0, until = 0;  ///< s
  std::vector<std::string> notes;
};

/// Reads the frames that `mill_file` (mill.yaml) names and makes the folder `out`, whole or not at all: frames.h5, case.resolved.yaml,
/// series.csv, summary.json; tracks.h5 where the frames are near enough in time for a camera. Throws base::UserError.
Imported import_frames(const std::filesystem::path& mill_file, const std::filesystem::path& out, const host::Registry& registry,
                       const std::vector<std::string>& command_line);

}  // namespace millscope::frames
