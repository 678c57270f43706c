// What is known of a recording's mill: what recording.yaml says, and of the rest what the tracer itself shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/analysis/mill.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {
struct MillMotion;  // studies/inspect/mill_motion.hpp
}

namespace millscope::analysis {

struct RecordedMill {
  std::array<double, 2> axis{0, 0};  ///< x, y in the frame of the file, m
  AnalyzerContext context{};
  std::vector<std::string> notes;  ///< what was estimated, with its interval
};

/// `mill`: of the geometry that the condition names. Throws base::UserError where the axis is neither given nor to be found, and where
/// the tracer contradicts the speed or the sense that are stated.
RecordedMill know_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill);
/// The same where the recording's motion is known already.
RecordedMill know_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill, const inspect::MillMotion& motion);

/// What is stated, taken as it stands and held against nothing: for the film of a simulation, whose mill is known.
RecordedMill stated_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill);

}  // namespace millscope::analysis
