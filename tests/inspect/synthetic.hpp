// Recordings with a known truth: a bead that rides with the shell, flies freely and lands, seen by a simple camera; a tracer on a rotor.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::test {

struct SyntheticMill {
  std::array<double, 2> axis{0.0021, -0.0034};  ///< m
  double angular_velocity = -6;                 ///< rad/s
  double radius = 0.145;                        ///< of the path along the shell, m
  double at_shell = 0.4;                        ///< part of the rides that touch the shell; the others lie within 0.93 of it
  double slip = 0;                              ///< largest part by which a ride is slower than the shell
  double gravity_degrees = 0;                   ///< direction of gravity from −y towards +x: the camera is turned
  double noise = 0.6e-3;                        ///< m
  double rate = 220;                            ///< locations per second before losses
  double fast = 1e9, lost_when_fast = 0;        ///< beyond this speed, m/s, this part of the locations is lost
  double seconds = 60;
  std::uint64_t seed = 1;
};

recording::Recording make_recording(const SyntheticMill& mill);

struct SyntheticRotor {
  double radius = 0.03;                     ///< m
  std::vector<double> speeds{1, 6, 12};     ///< rad/s, each for 40 s after a ramp of 5 s
  std::array<double, 3> axis{0.2, 1, 0.1};  ///< not normalised
  double noise = 0.3e-3;                    ///< m
  double rate = 60;                         ///< 1/s
};

recording::Recording make_recording(const SyntheticRotor& rotor);

}  // namespace millscope::test
