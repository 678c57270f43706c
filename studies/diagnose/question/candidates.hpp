// Physics that a base case may have left out: hypotheses of the loaded plugins, and values of the case itself that may be other than
// they are said to be.
#pragma once

#include <string>
#include <vector>

#include "kernel/config/case.hpp"
#include "kernel/host/registry.hpp"
#include "studies/diagnose/naming/fit.hpp"

namespace millscope::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Candidate {
  std::string name;
  std::string sentence;  ///< what to say when it is found
  std::string equation, citation;
  std::string parameter, unit;     ///< for tables: "rolling_friction", "1"
  std::vector<std::string> set;    ///< "path=value" that switch it on
  std::vector<std::string> paths;  ///< of the case, that take the value; empty: it is on or off
  double null_value = 0, far = 1;  ///< where it vanishes; the far end of its prior range, strength 1
  naming::StrengthRange range;     ///< of the strength (value − null)/(far − null)
  std::vector<std::string> excludes = {};
  naming::StrengthRange prior = {};     ///< `range` as it was asked
  naming::StrengthRange farthest = {};  ///< as far beyond its prior as the case allows, at most as far again

  bool on_or_off() const { return paths.empty(); }
  double value(double strength) const { return null_value + strength * (far - null_value); }
};

/// "path=value" for a strength; values have four significant digits, so that they mean the same run wherever they are written.
std::vector<std::string> settings_of(const Candidate& candidate, double strength);
/// The strength that the rounded value stands for.
double rounded_strength(const Candidate& candidate, double strength);
double rounded(double value);

/// Candidates of a base case, in alphabetical order, and why others do not apply.
struct Library {
  std::vector<Candidate> candidates;
  std::vector<Candidate> incomplete;  ///< need values that the base case lacks
  std::vector<std::string> left_out;  ///< "cohesion: already in the base case"
};

/// All that apply to the case: the plugins' hypotheses and the targets of targets.cpp.
Library library_of(const config::Case& base, const host::Registry& registry);

/// Adds the targets that apply, and what the others need: density of the tracer, spread of the sizes, stiffness of the contacts, height,
/// face angle and friction of lifters, end faces at rest, ripple of the speed. For the files of this room.
void add_targets(const config::Case& base, Library& library);

}  // namespace millscope::diagnose
