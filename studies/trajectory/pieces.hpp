// Unbroken stretches of points and the splines through them. For the files of this room.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::studies {

/// Points first … last−1 of a run, with no pause longer than the gap limit and no jump that no bead can do.
struct Span {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first; }
};

/// Every point is in exactly one span.
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
  std::vector<double> roughness;        ///< per interval: spectral density of the random acceleration, m²/s³; 0: none
};

/// The natural cubic spline through the points; variances are what noise of standard deviation `noise` (m) does to it.
void interpolate(const double* time, const double* value, std::size_t count, double noise, AxisSpline& spline);

/// How rough an interval turned out: the sum of squares that the data put there, and what its roughness lets expect.
struct Evidence {
  double found = 0, expected = 0;
};

/// The cubic smoothing spline: the mean of an integrated random walk of velocity, `roughness` (m²/s³) per interval, seen with white noise.
/// (Wahba 1978: the smoothing spline with penalty noise²/roughness.) Variances are those of the posterior. One point more than intervals.
void smooth(const double* time, const double* value, double noise, const std::vector<double>& roughness, AxisSpline& spline,
            std::vector<Evidence>& evidence);

/// −2 log likelihood of one stretch of points under a roughness that is the same everywhere, without constants.
double misfit(const double* time, const double* value, std::size_t count, double noise, double roughness);

/// The roughness that makes the data most likely given the noise, from at most some ten thousand points of the run.
double likely_roughness(const Run& run, std::size_t axis, const std::vector<Span>& spans, double noise);

/// Smoothing splines of the three coordinates of a span whose strength follows the motion: at an impact the roughness rises in all three
/// coordinates by one factor, in calm motion it falls.
void smooth_adaptively(const Run& run, const Span& span, const std::array<double, 3>& noise, const std::array<double, 3>& roughness,
                       std::array<AxisSpline, 3>& splines);

}  // namespace millscope::studies
