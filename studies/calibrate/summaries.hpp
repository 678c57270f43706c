// Which few numbers of the analyzers' many results are compared; for the files of this room.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/analysis/results.hpp"
#include "studies/calibrate/observation.hpp"
#include "studies/calibrate/study.hpp"

namespace millscope::calibrate {

/// One summary and how it is made of results.
struct Summary {
  Observable observable;
  enum Kind { number, sum, mean, along } kind = number;
  std::string analyzer, result;
  std::string weight;              ///< mean: the result of the same analyzer that weighs
  std::vector<std::size_t> cells;  ///< sum, mean: of these values
  double factor = 1;
  std::vector<double> places = {};  ///< along: mean over these places on the result's axis, between its values
};

struct SummaryChoice {
  bool measured_power = false;  ///< the recording has it: it is compared for itself, and so is the centre's x
  double mass = 0;              ///< kg, of the recorded charge
};

/// The summaries that a recording's results support: groups of bins that hold an eighth of the time each (the last of each distribution
/// follows from the others and is left out), the most visited regions, the terms of the study.
std::vector<Summary> choose_summaries(const studies::ResultSet& recorded, const Study& study, const SummaryChoice& choice);

/// The same summaries of other results, with covariance. A mean over cells in which nothing was seen is NaN; throws base::UserError where
/// the results lack a summary or another value is undefined.
Observation summarise(const studies::ResultSet& results, const std::vector<Summary>& summaries);

nlohmann::ordered_json to_json(const std::vector<Summary>& summaries);
std::vector<Summary> summaries_from(const nlohmann::ordered_json& json);

/// analysis.yaml of the analyzers behind them.
inline constexpr const char* kAnalyzers = R"(analyzers:
  distributions: {bins_x: 50, bins_y: 50, bins_speed: 60, largest_speed: 3}
  power: {cells_x: 25, cells_y: 25}
  pept_grid: {cells_x: 24, cells_y: 24}
)";

}  // namespace millscope::calibrate
