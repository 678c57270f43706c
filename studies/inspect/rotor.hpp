// A tracer on a rotor, as in a calibration: circular motion of constant radius at stepped speeds.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

/// A time of steady speed.
struct Plateau {
  std::size_t run = 0;
  double start = 0, end = 0;  ///< s
  base::Interval90 speed;     ///< rad/s, its magnitude
};

struct Rotor {
  base::Interval90 radius;         ///< m
  std::array<double, 3> centre{};  ///< m
  std::array<double, 3> axis{};    ///< unit normal of the plane of rotation, of the sign about which most of the motion is positive
  double scatter = 0;              ///< standard deviation of the points about the circle, m
  double share = 0;                ///< of the points that lie on the circle
  std::vector<Plateau> plateaus;   ///< in order of time; times at rest are left out
};

/// None unless nearly all points lie on one circle and go round it.
std::optional<Rotor> recognise_rotor(const recording::Recording& recording);

}  // namespace millscope::inspect
