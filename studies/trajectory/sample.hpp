// Splines at even times. For the files of this room.
#pragma once

#include "studies/trajectory/pieces.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::trajectory {

/// A piece with its even times, whole multiples of the step within first … last (s), so that they do not depend on where a piece begins;
/// nothing else is filled in. Size 0 where there is none.
Piece empty_piece(double first, double last, double step);

/// Fills positions, velocities and their variances. `time`: of the knots.
void sample(const double* time, const Spline& spline, Piece& piece);

}  // namespace millscope::trajectory
