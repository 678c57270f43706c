// Writes a run as an `.a` file, the tracker's own layout: nine header lines, then t (ms), x, y, z, u (mm), 0, 0, number of events.
#pragma once

#include <filesystem>
#include <string>

#include "studies/recording/recording.hpp"

namespace millscope::camera {

/// Text of the file. Times to 0.1 µs and lengths to 1 µm, finer than real files, so that nothing is lost; u and the number of events
/// are 0 where the run has none.
std::string ctrack_text(const recording::Run& run);

/// The run with the digits that ctrack_text() writes; order and duplicates are clean_recording's.
recording::Run as_written(recording::Run run);

/// recording.yaml for files that lie beside it, with what is known of the mill. `note`: a comment line, without '#'.
std::string recording_text(const std::vector<std::string>& files, const recording::Condition& condition, const std::string& note);

}  // namespace millscope::camera
