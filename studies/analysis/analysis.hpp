// A whole analysis: from what the user names to results.
//
//   # analysis.yaml
//   analyzers:                       # without this map: every analyzer that the data allow
//     pept_grid: {cells_x: 40, cells_y: 40}
//     close: {kind: pept_grid, half_width: 50 mm}
//   resampling: {draws: 400, seed: 7, block: 2 s}
//   trajectory: {kind: smoothing, noise: 0.5 mm, low: 50 mm, high: 220 mm}
//   from: 10 s
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/analysis/engine.hpp"
#include "studies/analysis/open_source.hpp"

namespace millscope::analysis {

struct AnalysisRequest {
  std::filesystem::path path;             ///< directory of a run, recording.yaml, file of locations
  std::vector<std::string> tracers;       ///< see SourceRequest
  std::optional<double> from, to;         ///< s; over those of the settings
  std::filesystem::path settings;         ///< analysis.yaml; empty: none
  std::vector<std::string> overrides;     ///< --set, on the settings
  std::vector<std::string> only;          ///< names of instances or plugins; empty: all
  std::vector<std::string> command_line;  ///< for the provenance
  int threads = 0;
  std::function<void(const char* doing, double fraction)> progress;
};

/// Of these analyzers the means alone: their errors are resampled as little as may be.
AnalysisRequest request_of_means(const std::filesystem::path& path, std::vector<std::string> only);

/// Throws base::UserError.
ResultSet analyze(const AnalysisRequest& request, const host::Registry& registry);

}  // namespace millscope::analysis
