// study.yaml of a diagnosis: a study of `calibrate` with what may be other than it is said to be.
//
//   nuisances:                                   # beside the parameters; with a prior
//     fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %, name: filling}
//   hypotheses:                                  # without this map: all that are loaded and apply
//     rolling_resistance: {}
//     speed_dependent_restitution: {set: {pairs.glass~glass.reference_restitution: 0.8}}
//     lining: {sentence: The liner is rubber., path: pairs.glass~liner.restitution, without: 0.55, range: [0.2, 0.55]}
//     ends: {sentence: The mill has end faces., set: {geometry.liner.end_faces: true}}
//   bank: {base: 24, each: 10}
//   power_error: 0.5 %                           # of speed and meter together
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/study.hpp"
#include "studies/diagnose/candidates.hpp"

namespace millscope::diagnose {

/// A value of the case that is known with an error only.
struct Nuisance {
  std::string path, name;
  double low = 0, high = 0;  ///< what the bank covers
  double mean = 0, sigma = 0;
  config::Location where;
};

/// How many simulations of each kind the bank has in every condition.
struct BankSize {
  int base = 24;  ///< without an effect
  int each = 10;  ///< with each candidate
  int first = 4;  ///< of them before the candidate is screened
};

struct Question {
  calibrate::Study study;
  std::vector<Nuisance> nuisances;
  std::vector<Candidate> candidates;
  std::vector<std::string> left_out;  ///< hypotheses that do not apply, and why
  BankSize bank;
  std::vector<double> speed;  ///< |Ω| of every condition, rad/s

  std::size_t dimensions() const { return study.parameters.size() + nuisances.size(); }
  std::vector<Coordinate> coordinates() const;
  /// "path=value" of a parameter set, rounded as the bank rounds.
  std::vector<std::string> settings(const VectorXd& theta, const std::vector<Effect>& effects) const;
};

/// Throws config::UserError with file:line: unknown keys, hypotheses that no loaded plugin has, a prior outside the range.
Question read_question(const std::filesystem::path& file, const std::vector<std::string>& overrides, const host::Registry& registry);

}  // namespace millscope::diagnose
