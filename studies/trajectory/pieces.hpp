// Unbroken stretches of points and the splines through them. For the files of this room.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::trajectory {

/// Points first … last−1 of a run, with no pause longer than the gap limit and no jump that no bead can do.
struct Span {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first; }
};

/// Every point is in exactly one span.
std::vector<Span> unbroken(const recording::Run& run, double gap_limit, recording::Travel travel);
/// With the travel of the run itself.
std::vector<Span> unbroken(const recording::Run& run, double gap_limit);

/// The points of one span: x, y, z at `count` times.
struct Points {
  const double* time;
  std::array<const double*, 3> position;
  std::size_t count;
};
Points points_of(const recording::Run& run, const Span& span);

/// One number for each coordinate.
using Lanes = std::array<double, 3>;

/// Position and velocity at a knot, and their variances and covariance: m, m/s, m², m²/s, (m/s)².
struct Knot {
  Lanes x{}, v{}, xx{}, xv{}, vv{};
};

/// Between a knot and the next, summed over the coordinates: covariances of their positions and velocities ("xv": position here, velocity
/// there), and the spectral density of the random acceleration, m²/s³.
struct Between {
  double xx = 0, xv = 0, vx = 0, vv = 0, roughness = 0;
};

/// Cubic splines of the three coordinates in Hermite form.
struct Spline {
  std::vector<Knot> knots;
  std::vector<Between> between;  ///< one less
};

/// Points of which those that lie close together are averaged.
struct Averaged {
  std::vector<double> time;
  std::array<std::vector<double>, 3> position;
  std::vector<double> variance;  ///< of each, where that of a single point is 1
  Points points() const { return {time.data(), {position[0].data(), position[1].data(), position[2].data()}, time.size()}; }
};

/// Averages groups of consecutive points within `interval` (s), in time and position. `correlation`: of the noise from point to point.
Averaged average(const Points& points, double interval, double correlation);

/// Natural cubic splines through the points; variances are what noise of standard deviation `noise` (m) does to them.
void interpolate(const Averaged& averaged, const Lanes& noise, Spline& spline);

/// Between consecutive points, s, from at most some thousand of them.
double median_interval(const Points& points);

/// How rough an interval turned out: the sum of squares that the data put there, and what its roughness lets expect.
struct Evidence {
  double found = 0, expected = 0;
};

/// Strength of the noise (m), of the random walk (m²/s³), and the factor of the latter in each interval.
struct SmoothingBy {
  const Lanes &noise, &roughness;
  const std::vector<double>& factor;
};
/// Cubic smoothing splines: the mean of an integrated random walk of velocity seen with white noise. (Wahba 1978: the smoothing spline with
/// penalty noise²/roughness.) Variances are those of the posterior.
void smooth(const Points& points, const SmoothingBy& by, Spline& spline);
/// What that spline says of the factors.
void weigh_evidence(const Points& points, const SmoothingBy& by, std::vector<Evidence>& evidence);

/// −2 log likelihood of each coordinate of a span under a roughness that is the same everywhere, without constants.
Lanes misfit(const Points& points, const Lanes& noise, const Lanes& roughness);

/// The noise, m, and about how rough the motion is, m²/s³; 0: not known.
struct RoughnessSearch {
  Lanes noise, begin;
};
/// The roughness that makes each coordinate most likely given the noise, from at most some ten thousand points of the run.
Lanes likely_roughness(const recording::Run& run, const std::vector<Span>& spans, const RoughnessSearch& search);

/// Smoothing splines whose strength follows the motion: at an impact the roughness rises in all three coordinates by one factor, in calm
/// motion it falls.
void smooth_adaptively(const Points& points, const Lanes& noise, const Lanes& roughness, Spline& spline);

}  // namespace millscope::trajectory
