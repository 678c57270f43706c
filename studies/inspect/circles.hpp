// Circles through points of a plane that lie on them, near them or within them. For the files of this room.
#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "studies/inspect/windows.hpp"

namespace millscope::inspect {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< rad

struct Circle {
  double x = 0, y = 0;  ///< centre, m
  double radius = 0;    ///< m
};

/// Points of the plane; `group` says what is resampled together.
struct PlanePoints {
  std::vector<double> x, y;
  std::vector<std::size_t> group;
  std::size_t size() const { return x.size(); }
};

/// A rigid rotation that windows share, and the circle that holds 99 % of the points.
struct Rotation {
  Circle circle;
  double angular_velocity = 0;  ///< rad/s
  std::size_t support = 0;      ///< windows that turn so, in the outer quarter of the circle
};

/// Tries pairs of windows for the rotation with the largest support. `noise`: of a component of a point, m. None where fewer than
/// ten windows agree.
std::optional<Rotation> search_rotation(const std::vector<Parabola>& windows, const PlanePoints& points, double noise);

/// The circle that many points lie on and nearly none beyond: Σ exp(−e²/2s²) − 10 Σ_{e>0} (1 − exp(−e²/2s²)), e = |x − c| − R, on a grid
/// of centres within ± `span` of the guess's. `weights`: of the points; empty: all 1.
Circle touching_circle(const PlanePoints& points, const std::vector<double>& weights, const Circle& guess, double span, double scale);

/// The circle near `start` with the largest Σ w exp(−e²/2s²). Weights may be empty.
Circle ridge_circle(const PlanePoints& points, const std::vector<double>& weights, const Circle& start, double scale);

}  // namespace millscope::inspect
