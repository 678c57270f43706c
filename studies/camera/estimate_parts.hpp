// Parts of estimate_camera; for the files of this room only.
#pragma once

#include <array>
#include <cmath>

#include "studies/camera/estimate_camera.hpp"

namespace millscope::camera {

/// Real motion is no Gaussian process, and distance and speed are known from noisy locations: over recordings synthesized from simulated
/// beads the estimates of noise and losses scatter about the truth by one and a half times what the likelihood says
/// (docs/virtual_camera.md).
inline constexpr double kCaution = 1.5;

/// Where the camera sees best. In a slice that repeats along z a bead is where its image nearest to the middle is, as for the camera links
/// that depend on distance.
struct Middle {
  std::array<double, 3> at{};
  double period = 0;  ///< m; 0: a mill with ends
  double distance(double x, double y, double z) const {
    const double beside = z - at[2];
    return std::hypot(x - at[0], y - at[1], period > 0 ? std::remainder(beside, period) : beside);
  }
  /// Of point i of a run.
  double distance(const recording::Run& run, std::size_t i) const {
    return distance(run.position[0][i], run.position[1][i], run.position[2][i]);
  }
};

CameraNoise estimate_camera_noise(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most_stretches);

/// A short span of a trajectory: how many locations came, and how far and fast the bead was.
struct RateWindow {
  double seconds;
  double count;
  double distance;    ///< m
  double speed;       ///< m/s
  std::size_t group;  ///< of neighbouring windows that are not independent
};

struct RateModel {
  Estimated rate;
  CameraLosses loss;
  double lowest_rate = 0;  ///< that one window in two hundred falls below, 1/s
};

/// Windows of all runs; pauses longer than `pause` are left out.
std::vector<RateWindow> rate_windows(const recording::Recording& recording, const Middle& middle, double pause);
RateModel estimate_rate(const std::vector<RateWindow>& windows);
/// Fills the parameters of the cut from the spreads that the recording has, or from a scale of its own.
void express_as_cut(CameraLosses& loss, const recording::Recording& recording, const Middle& middle,
                    const std::vector<RateWindow>& windows);

CameraGaps estimate_gaps(const recording::Recording& recording, double limit);
/// Evenness and dead time from the intervals shorter than `pause`, given the rate and the losses.
void estimate_intervals(CameraSampling& sampling, const recording::Recording& recording, const RateModel& model, double pause);

}  // namespace millscope::camera
