// The bed as a picture shows it, in the place of a recording: a camera looks through the end face, and its pictures are averaged over time.
//
//   silhouette:
//     file: drum_30rpm.png
//     drum: {centre: [203, 203], diameter: 406}
//     greys: {covered: 22, free: 247}
//     angle_error: 0.5 deg
//     edge_error: 0.5 mm
//
// or, where only the slope of the surface is known:
//
//   surface_angle: {value: 37.4 deg, error: 0.5 deg}
//
// docs/calibrate.md explains the keys.
#pragma once

#include <optional>
#include <vector>

#include "studies/calibrate/figure.hpp"

namespace millscope::calibrate {

/// Cells from shell to shell in which pictures and simulations are measured.
inline constexpr int kSilhouetteCells = 160;

struct Silhouette : Figure {
  std::vector<double> covered;  ///< kSilhouetteCells², row by row upwards: share of the time that beads cover the cell, 0 … 1
  double covered_grey = 0, free_grey = 0;
  double angle_error = 0;            ///< rad
  std::optional<double> edge_error;  ///< m

  /// The section `silhouette` of a recording.yaml. Throws base::UserError with file:line.
  static Silhouette read(const config::Node& section);
  const char* what() const override { return "a silhouette"; }
  void measure(const FigureOf& of, RecordedCondition& r) const override;
};

struct SurfaceAngle : Figure {
  double value = 0, error = 0;  ///< rad

  static SurfaceAngle read(const config::Node& section);
  const char* what() const override { return "an angle of the surface"; }
  void measure(const FigureOf& of, RecordedCondition& r) const override;
};

}  // namespace millscope::calibrate
