#include "studies/calibrate/recorded_camera.hpp"

#include <fmt/format.h>

#include "kernel/base/text.hpp"
#include "studies/calibrate/recordings.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

constexpr const char* kExactCamera = "schema_version: 1\nobservations: {rate: {kind: sampling, rate: 1000 Hz, shape: 1000}}\n";

}  // namespace

RecordingCamera camera_of(const Recorded& recorded, const Study& study) {
  const recording::Recording& recording = recorded.tracks();
  if (study.observing.camera == "exact") return {kExactCamera, {}};
  if (study.observing.camera != "recording") return {base::text_of(study.observing.camera), {}};
  try {
    camera::EstimateOptions options;
    if (!recording.frame) options.motion = &recorded.motion();
    const camera::CameraEstimate estimate = camera::estimate_camera(recording, options);
    std::string text = camera::camera_text(estimate, recording.file.string());
    // No recording tells its location window; about one over the rate is usual, and nearer to the truth than none.
    if (const std::size_t blur = text.find("# blur: {"); blur != std::string::npos) text.erase(blur, 2);
    return {text, estimate.loss};
  } catch (const UserError& e) {
    throw UserError(fmt::format("the camera cannot be estimated: {}; give one with 'observe: {{camera: FILE.yaml}}'", e.what()));
  }
}

}  // namespace millscope::calibrate
