// A study against the plugins, the base case and the recordings.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kernel/config/case.hpp"
#include "kernel/config/writer.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/calibrate/study.hpp"
#include "studies/calibrate/velocity_profile.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

/// The case as it would be run, or the reader's own message at the place in the study.
std::string resolved(const Study& study, const std::vector<std::string>& settings, const host::Registry& registry,
                     const base::Location& where, const std::string& what) {
  try {
    const config::Case c = config::read_case(study.base.string(), settings);
    const std::vector<const Descriptor*> descriptors = registry.descriptors();
    config::finish(c, descriptors);
    return config::resolved_yaml(c, descriptors);
  } catch (const UserError& e) {
    throw UserError(where, fmt::format("{}: {}", what, e.what()));
  }
}

void check_parameter(const Study& study, std::size_t index, const host::Registry& registry) {
  const Parameter& p = study.parameters[index];
  std::vector<std::string> paths = p.tied;
  paths.insert(paths.begin(), p.path);
  const std::vector<std::string>& condition = study.conditions[study.with_role(Role::fit).front()].settings;
  for (const std::string& path : paths) {
    std::string text[2];
    for (const int end : {0, 1}) {
      std::vector<std::string> settings = condition;
      settings.push_back(fmt::format("{}={:.17g}", path, end == 0 ? p.low : p.high));
      text[end] = resolved(study, settings, registry, p.where, fmt::format("parameter '{}' at {:.6g}", path, end == 0 ? p.low : p.high));
    }
    if (text[0] == text[1]) {
      throw UserError(p.where,
                      fmt::format("parameter '{}' changes nothing in {}: the case overrides it; leave it out", path, study.base.string()));
    }
  }
}

/// One quantity that recording and case must share.
struct Shared {
  const char* what;
  double recorded, simulated, tolerance;  ///< relative
  double factor;                          ///< to the unit that is shown
  const char* unit;
};

void compare(const Study& study, const Condition& condition, const Shared& s) {
  if (!(s.recorded > 0) || !(s.simulated > 0)) return;  // not stated
  if (std::fabs(s.recorded - s.simulated) <= s.tolerance * s.simulated) return;
  throw UserError(
      condition.where,
      fmt::format("condition '{}': {} was made with a {} of {:.4g} {}, but the case {} has {:.4g} {}; name the recording of this "
                  "mill, or correct the case or the condition's 'set'",
                  condition.name, condition.recording.string(), s.what, s.factor * s.recorded, s.unit, study.base.string(),
                  s.factor * s.simulated, s.unit));
}

void check_condition(const Study& study, const Condition& condition, const host::Registry& registry) {
  resolved(study, condition.settings, registry, condition.where, fmt::format("condition '{}'", condition.name));
  const studies::MillOfCase mill = studies::read_mill_of_case(study.base, registry, condition.settings);
  const auto profile = read_profile(condition.recording);
  if (profile && study.objective.kind == ObjectiveKind::chagas2015)
    throw UserError(condition.where,
                    fmt::format("condition '{}': {} is a velocity profile, and chagas2015 compares tracks; take 'objective: "
                                "likelihood'",
                                condition.name, condition.recording.string()));
  const studies::Condition recorded = profile ? profile->condition : studies::read_recording(condition.recording).condition;
  const AnalyzerContext& c = mill.context;
  constexpr double kRpm = 30 / std::numbers::pi;
  compare(study, condition, {"mill diameter", recorded.mill_diameter.value_or(0), 2 * c.mill_radius, 0.005, 1e3, "mm"});
  compare(study, condition, {"bead size", recorded.bead_diameter.value_or(0), 2 * c.bead_radius, 0.01, 1e3, "mm"});
  compare(study, condition, {"filling", recorded.filling.value_or(0), c.filling, 0.01, 100, "%"});
  compare(study, condition, {"turning speed", recorded.speed.value_or(0), std::fabs(c.omega), 0.005, kRpm, "rpm"});
}

}  // namespace

void check_study(const Study& study, const host::Registry& registry) {
  resolved(study, {}, registry, study.base_place, "base");
  for (std::size_t p = 0; p < study.parameters.size(); ++p) check_parameter(study, p, registry);
  for (const Condition& condition : study.conditions) check_condition(study, condition, registry);
}

}  // namespace millscope::calibrate
