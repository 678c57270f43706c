// What was measured of a mill without following a bead: a velocity profile, a picture of the bed, the angle of its surface. It stands in
// the place of a recording:
//
//   # drum.yaml
//   silhouette: {file: drum.png}                    # or profile: {…}, surface_angle: {…}
//   condition: {speed: 30 rpm, mill_diameter: 84 mm}
//
// Simulations are compared by analyzers over all their beads, without a camera.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "studies/calibrate/recorded.hpp"

namespace millscope::calibrate {

/// Where a figure stands: in which condition of which study, and in which mill.
struct FigureOf {
  const Study& study;
  const Condition& condition;
  const analysis::MillOfCase& mill;
};

class Figure {
 public:
  virtual ~Figure() = default;
  /// "a velocity profile"
  virtual const char* what() const = 0;
  /// Fills in the summaries, the lines of the analyzers behind them, values, covariance and notes. Throws base::UserError where the figure
  /// cannot be of that mill.
  virtual void measure(const FigureOf& of, RecordedCondition& r) const = 0;

  recording::Condition condition;            ///< as stated
  std::vector<std::filesystem::path> files;  ///< beside the recording.yaml
};

/// The figure that a recording.yaml tells of; nothing where it tells of tracks. Throws base::UserError with file:line.
std::unique_ptr<const Figure> read_figure(const std::filesystem::path& recording);

RecordedCondition look_at_figure(const Figure& figure, std::size_t condition, const Processing& how);

/// What a finished run shows of it.
analysis::ResultSet figure_of_run(const std::filesystem::path& run, const RecordedCondition& recorded, const Processing& how);

}  // namespace millscope::calibrate
