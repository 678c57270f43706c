#include "studies/diagnose/bank/frame_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>

#include "studies/analysis/mill.hpp"
#include "studies/diagnose/naming/naming.hpp"
#include "studies/diagnose/question/camera_frame.hpp"
#include "studies/inspect/flight.hpp"
#include "studies/inspect/mill_motion.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kExact = 1e-3;  // error of a simulation's reading, of the recording's: its frame is known

/// Value and standard error as such: the interval is wider than normal where few rides or flights lie behind it.
FrameReading reading(const inspect::Finding& finding) {
  FrameReading r;
  if (!finding.estimate || finding.bound != inspect::Bound::both) return r;
  r.value = finding.estimate->value;
  r.sem = finding.estimate->standard_error();
  return r;
}

FrameReading scaled(FrameReading r, double factor) {
  r.value *= factor, r.sem *= std::fabs(factor);
  return r;
}

bool doubts(const Question& q, const std::string& parameter) {
  return std::any_of(q.nuisances.begin(), q.nuisances.end(), [&](const Nuisance& n) { return camera_frame_parameter(n) == parameter; });
}

struct Reader {
  const calibrate::Recorded& recorded;
  const ExpectedMill& mill;
  const recording::Recording& recording = recorded.tracks();
  std::optional<inspect::FreeFlight> flight = {};

  const inspect::MillMotion& rides() { return recorded.motion(); }

  /// An inner layer of the charge turns on a circle, too, but slower.
  bool along_shell() {
    const auto& radius = rides().path_radius.estimate;
    return rides().rides > 0 && radius && mill.path_radius > 0 && std::fabs(radius->value - mill.path_radius) < mill.bead_radius;
  }

  FrameReading axis(std::size_t along) {
    if (!recording.frame || !along_shell()) return {};
    FrameReading r = reading(rides().axis[along]);
    r.value -= recording.frame->axis[along];
    return r;
  }

  /// t' = (1 + κ) t makes Ω' = Ω/(1 + κ).
  FrameReading clock() {
    if (!recording.condition.speed || !along_shell()) return {};
    const FrameReading speed = reading(rides().speed);
    if (!(speed.value > 0)) return {};
    const double ratio = *recording.condition.speed / speed.value;
    FrameReading r;
    r.value = ratio - 1, r.sem = ratio * speed.sem / speed.value;
    return r;
  }

  FrameReading tilt() {
    if (!mill.upright) return {};
    if (!flight) flight = inspect::measure_flight(recording);
    return scaled(reading(flight->angle_degrees), std::numbers::pi / 180);
  }
};

void append(const std::vector<FrameReading>& readings, const VectorXd& values, double error, calibrate::Observation& o) {
  const Index n = o.value.size(), more = values.size();
  o.value.conservativeResize(n + more);
  o.covariance.conservativeResizeLike(MatrixXd::Zero(n + more, n + more));
  if (o.resampled.size() > 0) o.resampled.conservativeResizeLike(MatrixXd::Zero(n + more, n + more));
  for (Index k = 0; k < more; ++k) {
    const FrameReading& r = readings[k];
    o.observables.push_back(r.observable);
    o.value[n + k] = r.per_unit * values[k];
    o.covariance(n + k, n + k) = std::pow(error * r.per_unit * r.sem, 2);
  }
}

}  // namespace

ExpectedMill expected_mill(const Question& question, std::size_t condition, const host::Registry& registry) {
  const analysis::MillOfCase mill =
      analysis::read_mill_of_case(question.study.base, registry, question.study.conditions[condition].settings);
  const AnalyzerContext& c = mill.context;
  const auto leans = [](const auto& varied) { return varied.path.starts_with("body_forces."); };
  const bool varied = std::any_of(question.study.parameters.begin(), question.study.parameters.end(), leans) ||
                      std::any_of(question.nuisances.begin(), question.nuisances.end(), leans);
  return {c.mill_radius > c.bead_radius ? c.mill_radius - c.bead_radius : 0, c.bead_radius, mill.upright && !varied};
}

std::vector<FrameReading> read_frame(const Question& question, const ExpectedMill& mill, const calibrate::Recorded& recorded) {
  std::vector<FrameReading> out;
  Reader reader{recorded, mill};
  const bool ellipse = doubts(question, "tilt_x") || doubts(question, "tilt_y");
  for (std::size_t i = 0; i < question.nuisances.size(); ++i) {
    const Nuisance& n = question.nuisances[i];
    const std::string parameter = camera_frame_parameter(n);
    FrameReading r;
    std::string unit, of;
    if ((parameter == "offset_x" || parameter == "offset_y") && !ellipse)
      r = reader.axis(parameter == "offset_x" ? 0 : 1), r.per_unit = 1e3, unit = "mm", of = "rides along the shell";
    else if (parameter == "clock")
      r = reader.clock(), r.per_unit = 1e2, unit = "%", of = "rides along the shell";
    else if (parameter == "tilt_z")
      r = reader.tilt(), r.per_unit = 1e3, unit = "mrad", of = "free flights";
    if (!(r.sem > 0)) continue;
    r.nuisance = i;
    r.observable = {fmt::format("{} by {}", n.name, of), unit, calibrate::ObservableKind::frame};
    out.push_back(std::move(r));
  }
  return out;
}

void share_errors(std::vector<std::vector<FrameReading>>& of_conditions) {
  std::map<std::size_t, int> conditions;
  for (const auto& readings : of_conditions) {
    for (const FrameReading& r : readings) ++conditions[r.nuisance];
  }
  for (auto& readings : of_conditions) {
    for (FrameReading& r : readings) r.sem *= std::sqrt(conditions[r.nuisance]);
  }
}

void add_readings(const std::vector<FrameReading>& readings, calibrate::Observation& recorded) {
  VectorXd values(readings.size());
  for (std::size_t k = 0; k < readings.size(); ++k) values[k] = readings[k].value;
  append(readings, values, 1, recorded);
}

void add_readings(const Question& question, const std::vector<FrameReading>& readings, const VectorXd& theta,
                  calibrate::Observation& simulated) {
  VectorXd values(readings.size());
  for (std::size_t k = 0; k < readings.size(); ++k) values[k] = theta[question.study.parameters.size() + readings[k].nuisance];
  append(readings, values, kExact, simulated);
}

std::string text_of(const std::vector<FrameReading>& readings) {
  std::string text;
  for (const FrameReading& r : readings) {
    const base::Interval90 i = base::Interval90::about(r.per_unit * r.value, r.per_unit * r.sem);
    fmt::format_to(std::back_inserter(text), "{}{} {:.3g} {} ({:.3g} … {:.3g})", text.empty() ? "" : ", ", r.observable.name, i.value,
                   r.observable.unit, i.low, i.high);
  }
  return text;
}

}  // namespace millscope::diagnose
