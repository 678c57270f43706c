// Short stretches of a recording from which the noise can be read.
#pragma once

#include "studies/camera/estimate_parts.hpp"
#include "studies/camera/noise_model.hpp"

namespace millscope::camera {

/// At most `most` stretches without a pause longer than `pause` (s), evenly spread over the recording; none overlaps another, and those
/// that hold an impact or a stray location are left out. Throws base::UserError when there are too few.
std::vector<Stretch> stretches_over(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most);

/// Stretches in which the bead rides with the bed, so that next to nothing but noise moves it off a cubic. They are chosen by slopes and
/// bends of radius and height, which the likelihood removes, hence not by their noise.
std::vector<Stretch> quiet_stretches(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most);

}  // namespace millscope::camera
