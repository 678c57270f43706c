// Prescribed motion of a rigid body: a pure function of time, so that a restart needs no state of it.
#pragma once

#include "kernel/base/vector3.hpp"

namespace millscope::dem {

using base::Vector3;

/// Rotation about a fixed axis, with a ramp from rest and a ripple, and a translation (steady or oscillating).
struct Motion {
  double speed = 0;  ///< Ω, rad/s, signed about `axis`
  Vector3 axis{0, 0, 1};
  Vector3 point{0, 0, 0};
  double start = 0;                        ///< s, at rest before
  double ramp = 0;                         ///< s, linear from 0 to Ω
  double ripple_amplitude = 0;             ///< fraction of Ω
  double ripple_frequency = 0;             ///< Hz
  double ripple_phase = 0;                 ///< rad
  Vector3 velocity{0, 0, 0};               ///< m/s
  Vector3 oscillation_amplitude{0, 0, 0};  ///< m
  double oscillation_frequency = 0;        ///< Hz
  double oscillation_phase = 0;            ///< rad
  double translation_start = 0;            ///< s
  double ahead = 0;                        ///< s, what the walls' clock shows beyond the time: they may have been turning before

  bool operator==(const Motion&) const = default;
};

/// Where the body is and how it moves: x_world = R x_body + offset; v = velocity + Ω × (x − centre).
struct Pose {
  double rotation[3][3];
  Vector3 offset;
  Vector3 centre;
  Vector3 velocity;
  Vector3 omega;
  double angle;
};

Pose pose_at(const Motion& motion, double time);

/// Angular speed (rad/s) about the axis at a time.
double angular_speed(const Motion& motion, double time);

}  // namespace millscope::dem
