// A recording as the measure of a condition; for the files of this room.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "studies/analysis/instances.hpp"
#include "studies/analysis/recorded_mill.hpp"
#include "studies/analysis/results.hpp"
#include "studies/analysis/source.hpp"
#include "studies/calibrate/bead_paths.hpp"
#include "studies/calibrate/summaries.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::calibrate {

/// What of this program decides what is seen of a recording and of a simulation: the code that runs and tracks pass, compiler, flags,
/// libraries.
std::string observing_program();

/// What a recording fixes for every simulation of its condition.
struct RecordedCondition {
  Observation observation;
  std::vector<Summary> summaries;
  std::string analyzers;          ///< of a velocity profile: what simulations are asked for; empty: tracks were recorded
  std::string camera;             ///< text of the camera file
  std::array<double, 3> noise{};  ///< m, that decides the smoothing
  double noise_correlation = 0;
  double gap_limit = 0;  ///< s
  AxialPlace place;      ///< of the recorded mill
  double mass = 0;       ///< kg, of the recorded charge
  double omega = 0;      ///< rad/s
  bool measured_power = false;
  std::string identity;  ///< hash of all that the above depends on
};

/// How tracks become results; the same for recordings and simulations.
struct Processing {
  const Study& study;
  const host::Registry& registry;
  int threads = 0;
  std::string analyzers = {};  ///< as in analysis.yaml; empty: those of the observables and the study's own
};

/// Tracks through spline and analyzers; runs of which nothing is left after cleaning are left out and noted. What is stated of the mill is
/// held against the tracks, and found in them where nothing is.
studies::ResultSet process(const studies::Recording& recording, const studies::TrajectoryOptions& options, const Processing& how);

/// The same in a mill that is known.
studies::ResultSet process_in(const studies::RecordedMill& known, const studies::Recording& recording,
                              const studies::TrajectoryOptions& options, const Processing& how);

/// Reads, estimates the camera, analyses; `cache`: a folder for the outcome.
RecordedCondition look_at_recording(std::size_t condition, const Processing& how, const std::filesystem::path& cache);

/// The recording again, through other analyzers.
studies::ResultSet results_of_recording(std::size_t condition, const RecordedCondition& recorded, const Processing& how);

/// FNV-1a over texts.
std::string hash_of(const std::vector<std::string>& texts);

/// A subtree of the study as text, for hashes.
std::string dump(const config::Node& node);

}  // namespace millscope::calibrate
