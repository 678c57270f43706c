// From measured points to positions and velocities at even times, with what the noise leaves uncertain; never across a gap.
//
// Two ways: `cubic`, an interpolating cubic spline per coordinate (Chagas 2015; points nearer to each other than half the median interval
// are averaged first, lest it swings between them), and `smoothing`, a cubic smoothing spline whose strength
// follows the noise and, along the way, the motion. A simulated bead that a camera has seen goes through the same code.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::trajectory {

enum class SplineKind { cubic, smoothing };

struct TrajectoryOptions {
  SplineKind kind = SplineKind::smoothing;
  double step = 1e-3;       ///< s between the even times
  double gap_limit = 0.05;  ///< s: a longer pause between two points ends a piece
  int least_points = 6;     ///< shorter pieces are left out and counted
  /// Standard deviation of each component of a point, m; 0: estimated from the run itself.
  std::array<double, 3> noise{0, 0, 0};
  /// Correlation of the noise from one point to the next, 0 … 0.9; absent: estimated, also where `noise` is given.
  std::optional<double> noise_correlation = std::nullopt;
  /// Of the motion: spectral density of the random acceleration of each component, m²/s³, about. The search for what makes the run most
  /// likely begins there, and ends sooner; 0: it begins with a wide one.
  std::array<double, 3> roughness{0, 0, 0};
  std::optional<recording::Travel> travel = std::nullopt;  ///< what parts two points that no bead joins; absent: measured from the run
  std::array<double, 2> axis{0, 0};                        ///< subtracted from x and y, m
  double low = 0, high = 0;  ///< only samples with low ≤ z ≤ high are kept (end-face trimming), pieces end there; equal: all
  bool operator==(const TrajectoryOptions&) const = default;
};

/// One unbroken stretch at even times.
struct Piece {
  double start = 0;                             ///< s, of the first sample
  double step = 0;                              ///< s
  std::array<std::vector<double>, 3> position;  ///< m, in the mill's frame
  std::array<std::vector<double>, 3> velocity;  ///< m/s
  std::vector<double> position_variance;        ///< per sample, mean of the components, m²
  std::vector<double> velocity_variance;        ///< (m/s)²
  std::vector<double> weight;                   ///< s: dwell time of each sample
  std::size_t size() const { return position[0].size(); }
};

struct Trajectory {
  std::string name;
  std::int64_t id = 0;  ///< of the bead; the number of the run in a recording
  double diameter = 0;  ///< m, 0: unknown
  double density = 0;   ///< kg/m³, 0: unknown
  std::vector<Piece> pieces;
  /// The points behind it, in the mill's frame.
  std::vector<double> location_time;
  std::array<std::vector<double>, 3> location_position;
  std::array<double, 3> noise{0, 0, 0};  ///< standard deviation of a point that was used, m
  double noise_correlation = 0;          ///< from one point to the next
  double covered = 0;                    ///< s in pieces, without what was trimmed
  double span = 0;                       ///< s from the first to the last point
  std::uint64_t points_left_out = 0;     ///< in pieces that are too short
  std::uint64_t samples_trimmed = 0;
};

/// Noise of the points apart from the motion, from the points themselves; robust against impacts, outliers and gaps.
struct NoiseEstimate {
  std::array<double, 3> standard_deviation{0, 0, 0};  ///< of each component, m
  double correlation = 0;                             ///< from one point to the next, 0 … 0.9
};
NoiseEstimate estimate_noise_model(const recording::Run& run, double gap_limit);
/// The same from all runs of one tracker together: steadier, for TrajectoryOptions::noise and noise_correlation.
NoiseEstimate estimate_noise_model(std::span<const recording::Run> runs, double gap_limit);

/// The most likely roughness of the motion on all runs (their geometric mean), for TrajectoryOptions::roughness; 0 where no run is long
/// enough to tell.
std::array<double, 3> estimate_roughness(std::span<const recording::Run> runs, const TrajectoryOptions& options);

/// Throws base::UserError when no piece is long enough, with the reason. Of a run that never comes between `low` and `high` no piece is
/// left; `samples_trimmed` tells.
Trajectory fit_trajectory(const recording::Run& run, const TrajectoryOptions& options);

}  // namespace millscope::trajectory
