// The bed as a picture shows it, in the place of a recording: a camera looks through the end face, and its pictures are averaged over time.
//
//   # drum.yaml
//   silhouette:
//     file: drum_30rpm.png            # PNG, BMP, JPEG, PGM: greys, or colours taken as greys
//     drum: {centre: [203, 203], diameter: 406}   # pixels, x to the right and y down from the upper left; default: the drum fills the
//     picture greys: {covered: 22, free: 247} # default: of the lowest and of the highest tenth of the drum angle_error: 0.5 deg # standard
//     error of how the camera stands, all directions together; this is the default edge_error: 0.5 mm              # standard error of
//     where the outline lies, all of it together; default: half the width of its blur
//   condition: {speed: 30 rpm, mill_diameter: 84 mm}
//
// or, where only the slope of the surface is known:
//
//   surface_angle: {value: 37.4 deg, error: 0.5 deg}
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
