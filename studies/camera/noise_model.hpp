// How likely a stretch of locations is, given the camera's noise and a bead that moves as it likes.
//
// symbol   here          meaning
// x, v     –             true position and velocity along one axis: any cubic of time, about which v wanders: dv = −v dt/T + q dW
// q, T     strength, memory   of the wandering, m/s^1.5 and s; beads in a resting bed have little, in the falling layer much
// c        –             correlated noise, an Ornstein–Uhlenbeck process of deviation σ_c and time τ
// f        factor        1 + γ d, growth with the distance from the rig's middle
//
//   y_i = x(t_i) + f_i (c(t_i) + σ_w a_i)
//
// The restricted likelihood (the cubic integrated out) is exact and costs a Kalman filter per stretch. A bead that turns with the bed
// through less than a radian follows a cubic to 0.1 % of the radius, so that stretches in a resting bed show the noise alone. q is not
// one number for all stretches: each takes its own from a fixed ladder. How often each rung is taken is learnt from the stretches
// (Laird 1978, doi:10.1080/01621459.1978.10480103; a fixed number of rounds). Were all rungs equally likely beforehand, a resting bead
// would pay for those that it cannot be on, and a wandering that is quickly forgotten, which makes the lower rungs alike, would be
// preferred and take the slow noise for itself.
#pragma once

#include <array>
#include <vector>

namespace millscope::camera {

/// Noise along one axis, in units of the factor.
struct NoiseStrength {
  double white = 0;       ///< σ_w, m
  double correlated = 0;  ///< σ_c, m
};

/// Consecutive locations without a gap.
struct Stretch {
  std::vector<double> time;                  ///< s, from the first
  std::array<std::vector<double>, 3> value;  ///< m
  std::vector<double> distance;              ///< from the rig's middle, m
  std::size_t run = 0, first = 0;            ///< where it begins
};

/// What one location keeps of the one before; the same for all axes and strengths.
struct Steps {
  /// `correlation_time` of the noise, `memory` of the bead's wandering, s; `growth` of the noise, 1/m.
  Steps(const Stretch& stretch, double correlation_time, double memory, double growth);
  double memory;
  std::vector<double> dt, kept, slowed;  ///< s; of the correlated noise; of the velocity
  std::vector<double> factor;
};

/// A number for every strength of the ladder.
using Rungs = std::array<double, 9>;

/// Restricted log-likelihood of each axis of a stretch for every strength of the wandering; NaN where the noise is none.
std::array<Rungs, 3> rung_likelihoods(const Stretch& stretch, const Steps& steps, const std::array<NoiseStrength, 3>& noise);

/// Log-likelihoods, one from those of each ladder: averaged with weights of the rungs that make all of them together likely.
std::vector<double> averaged_over_ladder(const std::vector<Rungs>& logs);

}  // namespace millscope::camera
