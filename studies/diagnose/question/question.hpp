// study.yaml of a diagnosis: a study of `calibrate` with what may be other than it is said to be.
//
//   nuisances:                                   # beside the parameters; with a prior
//     fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %, name: filling}
//     stiffness_factor: {range: [0.001, 0.01], mean: 0.003, sigma: 0.003, apart: true} # varied in simulations of its own only
//     camera.frame_error.offset_x: {range: [-5 mm, 5 mm], sigma: 1 mm, name: axis_x}   # of the camera: no simulation more
//   hypotheses:                                  # without this map: all that are loaded and apply
//     rolling_resistance: {}
//     speed_dependent_restitution: {set: {pairs.glass~glass.reference_restitution: 0.8}}
//     lining: {sentence: The liner is rubber., path: pairs.glass~liner.restitution, without: 0.55, range: [0.2, 0.55]}
//     ends: {sentence: The mill has end faces., set: {geometry.liner.end_faces: true}}
//   bank: {base: 24, each: 10, develop_turns: 1}   # begin where other simulations of the bank ended
//   power_error: 0.5 %                           # of speed and meter together
//   level: 5 %                                   # how often something is said to be missing where nothing is
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/calibrate/study.hpp"
#include "studies/diagnose/question/candidates.hpp"

namespace millscope::diagnose {

/// A value of the case, or of the recording's camera, that is known with an error only.
struct Nuisance {
  std::string path, name;            ///< of the camera: camera.frame_error.PARAMETER
  double low = 0, high = 0;          ///< what the bank covers
  naming::StrengthRange asked = {};  ///< the same as the study gives it; the bank may reach beyond
  double mean = 0, sigma = 0;
  std::optional<double> usual;  ///< varied apart: the case's own value, which all other simulations have
  base::Location where;

  bool of_camera() const { return path.starts_with("camera."); }
};

/// How many simulations of each kind the bank has in every condition.
struct BankSize {
  int base = 24;             ///< without a candidate
  int each = 10;             ///< with each candidate; half as many with it and each nuisance that is varied apart
  int apart = base;          ///< without a candidate, with each nuisance that is varied apart
  int first = 4;             ///< of them before the candidate is screened
  double develop_turns = 0;  ///< that a run which begins at another's end turns before it is looked at; 0: all begin at rest
};

/// How far a parameter or nuisance may lie beyond its range, natural units.
struct Farthest {
  double low = 0, high = 0;
};

struct Question {
  calibrate::Study study;
  std::vector<Nuisance> nuisances;  ///< those of the case, those of the case that are varied apart, those of the camera
  std::vector<Candidate> candidates;
  std::vector<std::string> left_out;  ///< hypotheses that do not apply, and why
  BankSize bank;
  double level = 0.05;             ///< of every statement, for all candidates together
  std::vector<Farthest> farthest;  ///< of θ's case_dimensions(), as far as the case allows: at most half a parameter's range, or all of a
                                   ///< nuisance's, beyond either end
  std::vector<double> speed;       ///< |Ω| of every condition, rad/s

  std::size_t dimensions() const { return study.parameters.size() + nuisances.size(); }
  /// Of θ, that vary in every simulation.
  std::size_t case_dimensions() const;
  std::vector<naming::Coordinate> coordinates() const;
  /// "path=value" of a parameter set, rounded as the bank rounds.
  std::vector<std::string> settings(const VectorXd& theta, const std::vector<naming::ActiveCandidate>& active) const;
  /// A camera file with what the recording's camera does besides at θ, before all else; "" where the study has no such nuisance.
  std::string camera(const VectorXd& theta) const;
};

/// A number of the case at a path. Throws base::UserError at `where` when the case does not say it.
double value_in(const config::Case& c, const std::string& path, const base::Location& where);

/// "path=… rad/s" for every speed that a case gives in % of critical: of the mill and of parts that turn by themselves. The critical speed
/// depends on the largest bead, which a candidate may change; a recorded mill turned as it did.
std::vector<std::string> speeds_settled(const config::Case& c);

/// Throws base::UserError with file:line: unknown keys, hypotheses that no loaded plugin has, a prior outside the range.
Question read_question(const std::filesystem::path& file, const std::vector<std::string>& overrides, const host::Registry& registry);

}  // namespace millscope::diagnose
