// What a recording says of its own camera: the parameters of a chain of observations, each with its standard error.
//
// What cannot be told from a recording: the location window (its blur looks like smooth motion), tilt and scale (free flight tells them
// better), and how far outliers lie where the reader has set them aside.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::inspect {
struct MillMotion;  // studies/inspect/mill_motion.hpp
}

namespace millscope::camera {

/// A value and its standard error.
struct Estimated {
  double value = 0;
  double error = 0;
};

/// Intervals between locations. Locations come at `rate` before losses.
struct CameraSampling {
  Estimated rate;         ///< 1/s
  Estimated shape{1, 0};  ///< evenness; 1: Poisson
  double dead_time = 0;   ///< s
};

/// σ(d) = (1 + growth d) (white, correlated) at distance d from the rig's middle.
struct CameraNoise {
  std::array<Estimated, 3> white, correlated;  ///< m, at the middle; correlated 0: none is found
  Estimated correlation_time;                  ///< s
  Estimated growth;                            ///< 1/m
  double near = 0, far = 0;                    ///< 5 % and 95 % of the locations are nearer than these, m
  Estimated total_near, total_far;             ///< deviation of both parts together, mean over the axes, at these distances, m
  std::size_t stretches = 0;                   ///< that were used
};

/// A location is kept with probability Φ(at_rest − per_distance d − per_speed v).
struct CameraLosses {
  bool found = false;           ///< losses differ from none by more than three standard errors
  Estimated at_rest;            ///< 1, of a bead at rest in the middle
  Estimated per_distance;       ///< 1/m
  Estimated per_speed;          ///< s/m
  double typical_distance = 0;  ///< median over the locations, m
  /// The same as a cut on the tracker's spread: `error_cut`'s parameters, m, m, 1, s, m.
  double cut = 0, spread = 0, spread_per_distance = 0, spread_per_speed = 0, scatter = 0;
  double kept(double distance, double speed) const;
};

struct CameraGaps {
  Estimated rate;         ///< 1/s
  Estimated mean_length;  ///< s
  double limit = 0;       ///< a longer pause cannot be chance, s
  std::size_t count = 0;  ///< pauses beyond it
};

struct CameraEstimate {
  CameraSampling sampling;
  CameraNoise noise;
  CameraLosses loss;
  CameraGaps gaps;
  Estimated outliers;                            ///< share of the locations
  std::optional<std::array<Estimated, 2>> axis;  ///< of the mill in the camera's frame, m; nothing: not known
  std::array<double, 3> middle{};                ///< that distances are counted from, in the camera's frame, m
  double seconds = 0;                            ///< of sight
  std::size_t locations = 0;
};

struct EstimateOptions {
  std::optional<recording::MillFrame> frame;  ///< where the mill stands; default: the recording's, else what its rides along the shell say
  std::size_t most_stretches = 300;           ///< for the noise: more cost more time
  const inspect::MillMotion* motion = nullptr;  ///< of this recording, where it is known already
};

/// Throws base::UserError when the recording is too short or sparse (fewer than 200 locations or 20 unbroken stretches of 24).
CameraEstimate estimate_camera(const recording::Recording& recording, const EstimateOptions& options = {});

/// The estimate with its standard errors; units are in the names of the keys, numbers that are not finite are null.
nlohmann::ordered_json camera_json(const CameraEstimate& estimate);

/// Fast beads that are under-represented, said where the recording shows it, for it is the camera and no physics; "" where it does not.
/// `speed`: of the shell, m/s.
std::string losses_text(const CameraLosses& loss, double speed);

/// The camera as YAML to be edited by hand, every value with its standard error in a comment.
std::string camera_text(const CameraEstimate& estimate, const std::string& source);

}  // namespace millscope::camera
