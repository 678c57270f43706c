// The calibrated set where nothing was fitted: does the simulation still agree with the recording?
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/calibrate/evaluator.hpp"

namespace millscope::calibrate {

inline constexpr double kFamilyLevel = 0.05;  ///< chance that anything fails when nothing differs and the set is exact

/// Simulated less recorded.
struct Judged {
  Observable observable;
  double recorded = 0, simulated = 0;
  double difference = 0, error = 0;  ///< error: standard error of both together
  double low = 0, high = 0;          ///< 90 % interval of the difference, for itself
  double p = 1;                      ///< two-sided, for itself
  bool pass = false;                 ///< p above the level that keeps the family's
};

struct ValidatedCondition {
  std::size_t condition = 0;
  bool failed = false;
  std::string message;
  std::vector<Judged> observables;
  Judged power;  ///< W, however it was measured
  ChagasObjective chagas;
  double misfit = 0;  ///< of all observables at once: many differences, each small enough for chance, may be too much for it
  double p = 1;       ///< of a misfit as large by chance (χ²)
  bool pass = false;  ///< p above the level that keeps the family's
  Observation simulated;
  std::filesystem::path folder;
};

struct Validation {
  Eigen::VectorXd point;
  std::vector<ValidatedCondition> conditions;
  std::size_t judged = 0, passed = 0;  ///< observables, one by one
  bool at_once = true;                 ///< all observables of a condition pass at once, in each condition that was simulated
  std::ptrdiff_t failed() const;       ///< simulations
  bool agrees() const { return judged == passed && at_once; }
  bool pass() const { return agrees() && failed() == 0; }
};

/// The set that calibration.json holds, in the order of the study's parameters. Throws base::UserError when it is no such file or holds
/// other parameters.
Eigen::VectorXd calibrated_set(const std::filesystem::path& file, const Study& study);

/// Simulates the set in the conditions given and judges every observable. Throws UserError when all simulations fail.
Validation validate(Evaluator& evaluator, const Eigen::VectorXd& point, const std::vector<std::size_t>& conditions);

nlohmann::ordered_json validation_json(const Validation& validation, const Evaluator& evaluator);
std::string validation_text(const Validation& validation, const Evaluator& evaluator);
/// validation.json, validation.md and pictures of the distributions.
void write_validation(const Validation& validation, const Evaluator& evaluator, const std::filesystem::path& folder);

}  // namespace millscope::calibrate
