// Which way is down: gravity from beads in free flight.
//
// Whole arcs through which a parabola fits within the noise are sought; no position is differentiated. Most of them are charge that turns
// slowly. Those of beads in free flight share one acceleration, of about 9.81 m/s², within no more than their own standard errors: a
// mixture of that one and the broad rest is fitted (expectation maximisation), gravity's direction and magnitude free.
#pragma once

#include <cstddef>

#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

struct FreeFlight {
  std::size_t arcs = 0;   ///< parabolic arcs, of any acceleration
  double flights = 0;     ///< of them, in free flight (sum of probabilities)
  Finding angle_degrees;  ///< of gravity in the x–y plane, from −y towards +x
  Finding axial_degrees;  ///< of gravity out of that plane, towards +z
  Finding magnitude;      ///< m/s²; away from 9.81 the recording's scale or clock is off, or air and neighbours brake the beads
};

FreeFlight measure_flight(const recording::Recording& recording);

}  // namespace millscope::inspect
