// Short spans of a recording through which parabolas are laid: positions with velocities, for the estimators of this room.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::inspect {

/// Consecutive points without a pause longer than the recording's gap limit.
struct UnbrokenStretch {
  const recording::Run* run = nullptr;
  std::size_t run_number = 0;
  std::size_t first = 0;
  std::size_t last = 0;  ///< one past the end
  std::size_t size() const { return last - first; }
  double duration() const { return run->time[last - 1] - run->time[first]; }
};

std::vector<UnbrokenStretch> unbroken_stretches(const recording::Recording& recording);

/// Least-squares parabola x(t) = c0 + c1 s + c2 s², s = t − middle, through points of one run.
struct Parabola {
  double middle = 0;                     ///< s
  double duration = 0;                   ///< s
  std::size_t count = 0;                 ///< points
  std::array<double, 3> position{};      ///< m, at the middle
  std::array<double, 3> velocity{};      ///< m/s
  std::array<double, 3> acceleration{};  ///< m/s²
  std::array<double, 3> scatter{};       ///< standard deviation of the points about it, m
  double acceleration_per_noise = 0;     ///< standard error of a component of the acceleration per unit of white noise, 1/s²
  double velocity_per_noise = 0;         ///< the same of the velocity, 1/s
};

/// Through the points first … last − 1; needs four points or more at different times.
Parabola fit_parabola(const recording::Run& run, std::size_t first, std::size_t last);

/// Sums that grow point by point, so that a span can be lengthened at the cost of one point.
class GrowingParabola {
 public:
  explicit GrowingParabola(double origin) : origin_(origin) {}
  void add(const recording::Run& run, std::size_t point);
  std::size_t count() const { return count_; }
  /// Variance of the points about the best parabola in each component, m²; 0 degrees of freedom give 0.
  std::array<double, 3> variance() const;

 private:
  double origin_;
  std::size_t count_ = 0;
  std::array<double, 5> power_{};                  // Σ sᵏ
  std::array<std::array<double, 3>, 3> moment_{};  // Σ x sᵏ for each axis
  std::array<double, 3> square_{};                 // Σ (x − x₀)²
  std::array<double, 3> base_{};                   // first point, so that sums stay small
};

/// Parabolas over spans of `length` seconds, half overlapping, with at least `least` points each.
std::vector<Parabola> local_parabolas(const std::vector<UnbrokenStretch>& stretches, double length, std::size_t least);

/// Dwell time of each point of a run, s: half of the pauses on both sides; pauses longer than the gap limit count nothing.
std::vector<double> dwell_times(const recording::Run& run, double gap_limit);

/// Median time between consecutive points, s.
double median_interval(const recording::Recording& recording);

}  // namespace millscope::inspect
