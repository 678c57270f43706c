// How much neighbouring points scatter.
#pragma once

#include <array>

#include "studies/recording/recording.hpp"

namespace millscope::recording {

/// Standard deviation of each component, m, from contrasts of four consecutive points that cancel every parabola (third divided
/// differences, scaled to unit norm); the median of their magnitudes, so that impacts and outliers hardly count. Contrasts across gaps
/// are left out. 0 where no four points lie together.
std::array<double, 3> difference_noise(const Run& run, double gap_limit);

/// With all contrasts, and without those across gaps.
struct DifferenceNoises {
  std::array<double, 3> all{}, unbroken{};
};
DifferenceNoises difference_noises(const Run& run, double gap_limit);

}  // namespace millscope::recording
