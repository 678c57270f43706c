// Unbroken stretches of points and the splines through them. For the files of this room.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::studies {

/// Points first … last−1 of a run, with no pause longer than the gap limit.
struct Span {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first; }
};

std::vector<Span> unbroken(const Run& run, double gap_limit);

/// Covariance of position and velocity at a knot.
struct StateVariance {
  double position = 0;  ///< m²
  double mixed = 0;     ///< m²/s
  double velocity = 0;  ///< (m/s)²
};

/// Covariance of a knot's position and velocity with those of the next knot.
struct CrossVariance {
  double position_position = 0, position_velocity = 0, velocity_position = 0, velocity_velocity = 0;
};

/// A cubic spline of one coordinate in Hermite form: position and velocity at each knot, and what is uncertain of them.
struct AxisSpline {
  std::vector<double> position, velocity;
  std::vector<StateVariance> variance;  ///< per knot
  std::vector<CrossVariance> cross;     ///< per interval, between its two knots
  double roughness = 0;                 ///< m²/s³, spectral density of the random acceleration between knots; 0: none
};

/// The natural cubic spline through the points; variances are what noise of standard deviation `noise` (m) does to it.
void interpolate(const double* time, const double* value, std::size_t count, double noise, AxisSpline& spline);

/// The cubic smoothing spline: the mean of an integrated random walk of velocity, strength `roughness` (m²/s³), seen with white noise.
/// (Wahba 1978: the smoothing spline with penalty noise²/roughness.) Variances are those of the posterior.
void smooth(const double* time, const double* value, std::size_t count, double noise, double roughness, AxisSpline& spline);

/// The roughness that makes the data most likely given the noise, from at most some ten thousand points of the run.
double likely_roughness(const Run& run, std::size_t axis, const std::vector<Span>& spans, double noise);

}  // namespace millscope::studies
