// Which points the camera lost: fast beads give fewer locations.
#pragma once

#include <vector>

#include "studies/inspect/circulations.hpp"
#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

/// One range of speed. Time within it: pauses between points, each at the speed of its neighbourhood; long pauses at that of their chord.
struct SpeedRange {
  double low = 0, high = 0;  ///< m/s
  double time = 0;           ///< s
  base::Interval90 rate;     ///< locations per second, 1/s
  base::Interval90 lost;     ///< part of the locations, against the slow range with the highest rate
};

struct Losses {
  std::vector<SpeedRange> ranges;
  Finding lost;            ///< of all locations, against the rate of slow beads, in the time that can be given a speed
  double unassigned = 0;   ///< s in pauses too long to say how fast the bead was
  Finding missed_rising;   ///< part of the rises whose middle falls into a pause that random points hardly ever make
  Finding missed_falling;  ///< the same of falls: each circulation has one of both, so without losses by speed both are alike
};

Losses measure_losses(const recording::Recording& recording, const Circulations& circulations);

}  // namespace millscope::inspect
