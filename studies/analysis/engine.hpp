// Runs analyzers over a source: sums of chunks, blocks, resampling, results.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "studies/analysis/instances.hpp"
#include "studies/analysis/results.hpp"
#include "studies/analysis/source.hpp"

namespace millscope::analysis {

struct EngineOptions {
  std::uint64_t seed = 1;
  std::size_t draws = 200;
  double block = 0;                                                  ///< s: least length of a block; 0: three autocorrelation times
  std::optional<BlockLengths> known = std::nullopt;                  ///< of the data that these are compared with; absent: from the data
  int threads = 0;                                                   ///< 0: all cores; no influence on results
  std::function<void(const char* doing, double fraction)> progress;  ///< may be empty; called from one thread at a time
  /// Results whose uncertainty is read: the others get values alone, and there is no joint covariance. Empty: all have one.
  std::function<bool(const std::string& analyzer, const std::string& result)> uncertain = {};
};

/// Fills arrays, covariance and, of meta, blocks, times, seed, draws and notes. The rest of meta is the caller's. Throws UserError when a
/// plugin refuses.
ResultSet run_analyzers(FrameSource& source, const std::vector<AnalyzerInstance>& instances, const EngineOptions& options);

}  // namespace millscope::analysis
