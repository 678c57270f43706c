// What `calibrate` leaves: calibration.json, calibrated.yaml, runs.csv, report.md with pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/calibrate/methods.hpp"

namespace millscope::calibrate {

nlohmann::ordered_json calibration_json(const Evaluator& evaluator, const Calibration& calibration);
/// A case below a line of comment that includes `base` (named relative to `folder`) and has the settings "path=value".
std::string case_with(const std::string& comment, const std::filesystem::path& base, const std::vector<std::string>& settings,
                      const std::filesystem::path& folder);
/// The base with what was found.
std::string calibrated_yaml(const Study& study, const Eigen::VectorXd& best, const std::filesystem::path& folder);
/// One line for each trial: number, stage, replicate, state, parameters, objectives, observables, folders.
std::string runs_csv(const Evaluator& evaluator);
/// Markdown that names the pictures in `pictures`.
std::string report_text(const Evaluator& evaluator, const Calibration& calibration, const std::vector<std::filesystem::path>& pictures);
/// Distributions observed and calibrated, profiles of the parameters, the surface, pairs of the posterior. SVG and PNG below `folder`;
/// returns the SVG files.
std::vector<std::filesystem::path> draw(const Evaluator& evaluator, const Calibration& calibration, const std::filesystem::path& folder);

/// The x and speed distributions of one condition alone.
std::vector<std::filesystem::path> draw_distributions(const std::string& condition, const Observation& recorded,
                                                      const Observation& simulated, const std::filesystem::path& folder);

/// All of the above into `folder`. An earlier calibration there is replaced whole.
void write_outputs(const Evaluator& evaluator, const Calibration& calibration, const std::filesystem::path& folder);

}  // namespace millscope::calibrate
