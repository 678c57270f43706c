// Nuisances of the recording's camera: where its axis stands, its level, its scale, its clock (plugin frame_error). They act on the beads
// before all that the camera does, so that a bank serves whatever they are. Blur, noise and losses belong further behind in the camera.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/calibrate/observe.hpp"
#include "studies/diagnose/question/question.hpp"

namespace millscope::diagnose {

/// Unit of camera.frame_error.PARAMETER. Throws base::UserError at `node`, the nuisance, where there is no such parameter.
std::string camera_frame_unit(const config::Node& node, const std::string& path, const host::Registry& registry);

/// PARAMETER of a nuisance camera.frame_error.PARAMETER; "" of one that is not the camera's.
std::string camera_frame_parameter(const Nuisance& nuisance);

/// A camera file with these nuisances at their values.
std::string camera_frame_text(const std::vector<std::pair<const Nuisance*, double>>& of);

/// Throws base::UserError where both ends of the range are no camera.
void check_camera_frame(const Nuisance& nuisance, const host::Registry& registry);

/// Before anything is simulated: the recordings must state what the study doubts, and turn as the case does. Throws base::UserError.
void check_recorded_frames(const Question& question, const calibrate::Observer& observer);

}  // namespace millscope::diagnose
