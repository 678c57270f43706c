#include "studies/calibrate/recordings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "studies/analysis/mill.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

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

void check_recorded(const Study& study, const Condition& condition, const Recorded& recorded, const host::Registry& registry) {
  if (!recorded.of_tracks() && study.objective.kind == ObjectiveKind::chagas2015)
    throw UserError(condition.where, fmt::format("condition '{}': {} is {}, and chagas2015 compares tracks; take 'objective: likelihood'",
                                                 condition.name, condition.recording.string(), recorded.figure().what()));
  const AnalyzerContext c = analysis::read_mill_of_case(study.base, registry, condition.settings).context;
  const recording::Condition& stated = recorded.stated();
  constexpr double kRpm = 30 / std::numbers::pi;
  compare(study, condition, {"mill diameter", stated.mill_diameter.value_or(0), 2 * c.mill_radius, 0.005, 1e3, "mm"});
  compare(study, condition, {"bead size", stated.bead_diameter.value_or(0), 2 * c.bead_radius, 0.01, 1e3, "mm"});
  compare(study, condition, {"filling", stated.filling.value_or(0), c.filling, 0.01, 100, "%"});
  compare(study, condition, {"turning speed", stated.speed.value_or(0), std::fabs(c.omega), 0.005, kRpm, "rpm"});
}

}  // namespace

const inspect::MillMotion& Recorded::motion() const {
  std::call_once(motion_asked_, [this] { motion_ = inspect::estimate_motion(tracks()); });
  return motion_;
}

std::shared_ptr<const Recorded> read_recorded(const std::filesystem::path& recording) {
  if (auto figure = read_figure(recording)) return std::make_shared<const Recorded>(std::move(figure));
  return std::make_shared<const Recorded>(recording::read_recording(recording));
}

Recordings read_recordings(const Study& study) {
  Recordings recordings;
  for (const Condition& condition : study.conditions) recordings.push_back(read_recorded(condition.recording));
  return recordings;
}

void check_recordings(const Study& study, const Recordings& recordings, const host::Registry& registry) {
  auto recorded = recordings.begin();
  for (const Condition& condition : study.conditions) check_recorded(study, condition, **recorded++, registry);
}

}  // namespace millscope::calibrate
