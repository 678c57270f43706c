// The camera that simulations of a condition are seen through. For the files of this room.
#pragma once

#include <string>

#include "studies/calibrate/study.hpp"
#include "studies/camera/estimate_camera.hpp"

namespace millscope::calibrate {

class Recorded;

struct RecordingCamera {
  std::string text;           ///< as in a camera file
  camera::CameraLosses loss;  ///< what the recording shows it to lose; nothing of a camera that is given
};

/// As the study says: estimated from the tracks, exact, or a file. Throws base::UserError.
RecordingCamera camera_of(const Recorded& recorded, const Study& study);

}  // namespace millscope::calibrate
