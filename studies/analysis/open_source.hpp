// From what the user names to a source of blocks: a directory of `millscope run` or `import`, a recording.yaml or a bare file of locations.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/config/document.hpp"
#include "kernel/host/registry.hpp"
#include "studies/analysis/results.hpp"
#include "studies/analysis/source.hpp"

namespace millscope::analysis {

struct SourceRequest {
  std::filesystem::path path;
  std::vector<std::string> tracers;          ///< ids of beads to follow instead of looking at all, or "all"; simulations only
  std::optional<double> from, to;            ///< s
  trajectory::TrajectoryOptions trajectory;  ///< `axis`, and for simulated beads noise and kind, are set by the source
  bool trajectory_given = false;             ///< the user has chosen them: also simulated beads go through them
  int threads = 0;                           ///< 0: all cores; no influence on results
};

struct OpenedSource {
  std::unique_ptr<FrameSource> source;
  ResultMeta meta;  ///< source, description, name, case_file, inputs, notes
};

/// Throws base::UserError.
OpenedSource open_source(const SourceRequest& request, const host::Registry& registry);

/// Reads `trajectory: {kind: cubic|smoothing, step, gap_limit, least_points, noise, noise_correlation, low, high}`
/// of the settings.
trajectory::TrajectoryOptions read_trajectory_options(const config::Node& section);

/// FNV-1a of a file's bytes, hexadecimal; of a file above 64 MiB its size and 64 MiB of it, one in each even part.
std::string file_hash(const std::filesystem::path& file);

}  // namespace millscope::analysis
