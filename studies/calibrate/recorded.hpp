// A recording as the measure of a condition; for the files of this room.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/calibrate/bead_paths.hpp"
#include "studies/calibrate/processing.hpp"
#include "studies/calibrate/summaries.hpp"

namespace millscope::calibrate {

class Recorded;

/// What a recording fixes for every simulation of its condition.
struct RecordedCondition {
  Observation observation;
  std::vector<Summary> summaries;
  std::string analyzers;  ///< of a figure: what simulations are asked for; empty: tracks were recorded
  std::string camera;     ///< text of the camera file
  Smoothing smoothing;
  AxialPlace place;  ///< of the recorded mill
  double mass = 0;   ///< kg, of the recorded charge
  double omega = 0;  ///< rad/s
  bool measured_power = false;
  double axis_path = 0;   ///< m, radius of the rides along the shell by which the axis was found; 0: it was stated, or found otherwise
  double axis_noise = 0;  ///< m, of their points
  std::string identity;   ///< hash of all that the above depends on
  bool operator==(const RecordedCondition&) const = default;
};

/// Estimates the camera and analyses what was recorded in a condition; `cache`: a folder for the outcome.
RecordedCondition look_at_recording(std::size_t condition, const Recorded& recorded, const Processing& how,
                                    const std::filesystem::path& cache);

/// The recording again, through the analyzers of `how`.
analysis::ResultSet results_of_recording(const Recorded& recorded, const RecordedCondition& known, const Processing& how);

}  // namespace millscope::calibrate
