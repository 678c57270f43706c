// The mill of a case: its shell, its motion and its charge, without the physics.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/dem/motion.hpp"
#include "kernel/host/registry.hpp"
#include "millscope/analyzer.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::analysis {

struct MillOfCase {
  std::string name;
  /// Everything that follows from the case; `has`, `start`, `end` and ids are the source's.
  AnalyzerContext context{};
  dem::Motion motion;   ///< of the shell
  double period = 0;    ///< along z, m; 0: not periodic
  bool upright = true;  ///< gravity points along −y
  std::vector<std::string> notes;
};

/// Where a slice that repeats along z begins and ends, m; nothing for a mill with ends.
std::optional<recording::Slice> slice_of(const MillOfCase& mill);

/// Reads a case, or what `millscope run` left of it (case.resolved.yaml). Of the plugins only those of geometry and gravity are used.
/// `settings`: as `--set`. Throws base::UserError.
MillOfCase read_mill_of_case(const std::filesystem::path& case_file, const host::Registry& registry,
                             const std::vector<std::string>& settings = {});

}  // namespace millscope::analysis
