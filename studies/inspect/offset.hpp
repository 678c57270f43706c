// How far beside the axis the charge hangs: what a recording adds to the power M g <x> Omega.
#pragma once

#include "studies/inspect/mill_motion.hpp"

namespace millscope::inspect {

/// Time-weighted mean of x less the axis's, m, over the covered time. `circulation`: mean time of one, s; not above 0: not known.
/// The interval holds the uncertainty of the axis.
Finding mean_offset(const recording::Recording& recording, const MillMotion& motion, double circulation);

}  // namespace millscope::inspect
