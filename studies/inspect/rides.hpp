// Rides: spans in which the tracer moves along the shell's circle. For the files of this room.
#pragma once

#include <vector>

#include "studies/inspect/circles.hpp"

namespace millscope::inspect {

/// One ride with its ends cut off: points first … last − 1 of a run, those within the band.
struct Ride {
  std::size_t run = 0;
  std::vector<std::size_t> points;
  double duration = 0;          ///< s
  double radius = 0;            ///< m, mean distance of its points from the centre
  double angular_velocity = 0;  ///< rad/s, slope of angle over time
  double deviation = 0;         ///< its standard error from the scatter of the angles
};

struct RideRule {
  double band = 0;           ///< m: how far from the circle a point may lie
  double least_angle = 0.4;  ///< rad: shorter rides are left out
  double cut_start = 0.1;    ///< part of the angle that is cut off where the ride begins: the bead is still arriving
  double cut_end = 0.2;      ///< and where it ends: it leaves before it is out of the band
  double longest = 2.5;      ///< rad: longer rides are divided, as units of resampling
};

/// Rides in the turning sense `sense` (±1).
std::vector<Ride> find_rides(const recording::Recording& recording, const Circle& circle, int sense, const RideRule& rule);

/// Standard deviation of the rides' radii about their mean, m; a common wall leaves little.
double radius_spread(const std::vector<Ride>& rides);

/// The points of rides, grouped by ride.
PlanePoints points_of(const recording::Recording& recording, const std::vector<Ride>& rides);

/// Largest density of the rides' angular velocities, weighted by their duration times `times` (one per ride; empty: 1), with a kernel of
/// relative width 0.8 %. Signed; 0 without rides.
double common_speed(const std::vector<Ride>& rides, const std::vector<double>& times);

}  // namespace millscope::inspect
