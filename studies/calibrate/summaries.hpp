// Which few numbers of the analyzers' many results are compared; for the files of this room.
#pragma once

#include <string>
#include <vector>

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
  bool operator==(const Summary&) const = default;
};

inline constexpr const char *kCentreX = "centre of mass x", *kCentreY = "centre of mass y";  ///< names of observables

/// Whether the uncertainty of an analyzer's result is read for a summary, a histogram or a power.
bool becomes_summary(const std::string& analyzer, const std::string& result, const std::vector<Term>& terms);

struct SummaryChoice {
  bool measured_power = false;  ///< the recording has it: it is compared for itself, and so is the centre's x
  double mass = 0;              ///< kg, of the recorded charge
};

/// The summaries that a recording's results support: groups of bins that hold an eighth of the time each (the last of each distribution
/// follows from the others and is left out), the most visited regions, the terms of the study.
std::vector<Summary> choose_summaries(const analysis::ResultSet& recorded, const Study& study, const SummaryChoice& choice);

/// The same summaries of other results, with covariance. A mean over cells in which nothing was seen is NaN; throws base::UserError where
/// the results lack a summary or another value is undefined.
Observation summarise(const analysis::ResultSet& results, const std::vector<Summary>& summaries);

}  // namespace millscope::calibrate
