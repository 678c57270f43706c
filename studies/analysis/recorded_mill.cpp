#include "studies/analysis/recorded_mill.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "studies/inspect/mill_motion.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;

constexpr double kRpm = 30 / std::numbers::pi;

/// What recording.yaml and the geometry say; 0 where they say nothing.
AnalyzerContext stated(const recording::Recording& recording, const std::optional<MillOfCase>& mill) {
  const recording::Condition& c = recording.condition;
  AnalyzerContext context{};
  context.is_recording = 1;
  context.gravity = 9.81;
  if (mill) {
    context.mill_radius = mill->context.mill_radius;
    context.mill_length = mill->context.mill_length;
    if (mill->period == 0) {  // a periodic slice has a length, but no end faces
      context.mill_low = mill->context.mill_low;
      context.mill_high = mill->context.mill_high;
    }
  }
  if (c.mill_diameter) context.mill_radius = 0.5 * *c.mill_diameter;
  if (recording.frame && recording.frame->high > recording.frame->low) {
    context.mill_low = recording.frame->low;
    context.mill_high = recording.frame->high;
    context.mill_length = recording.frame->high - recording.frame->low;
  }
  if (c.mill_length) context.mill_length = *c.mill_length;
  context.omega = c.angular_velocity.value_or(0);
  context.bead_radius = 0.5 * c.bead_diameter.value_or(c.tracer.diameter.value_or(0));
  context.bead_density = c.bead_density.value_or(c.tracer.density.value_or(0));
  context.filling = c.filling.value_or(0);
  context.porosity = c.porosity.value_or(0);
  return context;
}

/// M = (1 − φ) J V ρ (Chagas 2015, Eq. 4.1), V of the bare shell.
void weigh_charge(const recording::Condition& c, AnalyzerContext& context) {
  const double length = context.mill_length;
  if (!c.filling || !c.porosity || !(context.mill_radius > 0) || !(length > 0) || !(context.bead_density > 0)) return;
  const double solids = (1 - *c.porosity) * *c.filling * std::numbers::pi * context.mill_radius * context.mill_radius * length;
  const double bead = 4.0 / 3.0 * std::numbers::pi * std::pow(context.bead_radius, 3);
  context.charge_mass = solids * context.bead_density;
  if (bead > 0) context.charge_count = solids / bead;
}

std::string interval_text(const inspect::Finding& finding, double factor) {
  const base::Interval90& e = *finding.estimate;
  if (finding.bound == inspect::Bound::at_least) return fmt::format("{:.4g} (at least {:.4g})", factor * e.value, factor * e.low);
  return fmt::format("{:.4g} [{:.4g}, {:.4g}]", factor * e.value, factor * e.low, factor * e.high);
}

const char* sense_text(double omega) { return omega > 0 ? "counter-clockwise" : "clockwise"; }

void find_axis(const recording::Recording& recording, const inspect::MillMotion& motion, RecordedMill& known) {
  if (motion.sense == 0 || !motion.axis[0].estimate || !motion.axis[1].estimate) {
    throw UserError(fmt::format(
        "{}: the mill's axis is neither given nor to be found ({}); write it into a recording.yaml, e.g. 'frame: {{axis: [0, 0, mm]}}'",
        recording.file.string(), motion.axis[0].note));
  }
  known.axis = motion.centre();
  known.notes.push_back(fmt::format("the mill's axis was found at x = {} mm, y = {} mm; every place is relative to it",
                                    interval_text(motion.axis[0], 1e3), interval_text(motion.axis[1], 1e3)));
}

void find_speed(const recording::Recording& recording, const inspect::MillMotion& motion, RecordedMill& known) {
  const std::optional<double>& speed = recording.condition.speed;
  if (motion.sense == 0 || (!speed && !motion.speed.estimate)) {
    known.notes.push_back(
        fmt::format("the turning {} of the mill is neither given nor to be found ({})", speed ? "sense" : "speed", motion.speed.note));
    return;
  }
  known.context.omega = motion.sense * (speed ? *speed : motion.speed.estimate->value);
  const std::string found = speed ? "" : fmt::format(" at {} rpm", interval_text(motion.speed, kRpm));
  known.notes.push_back(fmt::format("the mill was found to turn {}{}", sense_text(motion.sense), found));
}

/// Holds the speed that is stated against the one found. Refuses what rides along the shell contradict, notes the rest.
void check_speed(const recording::Recording& recording, const inspect::MillMotion& motion, RecordedMill& known) {
  const inspect::Agreement agreement = inspect::compare_speed(recording.condition, motion);
  if (agreement == inspect::Agreement::unknown || agreement == inspect::Agreement::within) return;
  const double stated = *recording.condition.speed * kRpm;
  std::string what;
  if (agreement == inspect::Agreement::opposite) {
    what = fmt::format(
        "the mill is stated to turn {}, but the tracer moves along its shell {}; check the axes of recording.yaml, or its "
        "direction",
        sense_text(*recording.condition.angular_velocity), sense_text(motion.sense));
  } else {
    what = fmt::format("the mill is stated to turn at {:.4g} rpm, but {} rpm was found ({}){}", stated, interval_text(motion.speed, kRpm),
                       motion.speed.note, agreement == inspect::Agreement::far ? "; check the speed and its unit, or leave it out" : "");
  }
  const bool sure = agreement == inspect::Agreement::far || (agreement == inspect::Agreement::opposite && motion.rides > 0);
  if (sure) throw UserError(fmt::format("{}: {}", recording.file.string(), what));
  known.notes.push_back(what);
}

void find_radius(const inspect::MillMotion& motion, RecordedMill& known) {
  if (!motion.path_radius.estimate) {
    known.notes.push_back(fmt::format("the radius of the mill is neither given nor to be found ({})", motion.path_radius.note));
    return;
  }
  const bool bead_known = known.context.bead_radius > 0;
  known.context.mill_radius = motion.path_radius.estimate->value + known.context.bead_radius;
  known.notes.push_back(fmt::format("the shell's radius is taken for {:.4g} mm: {} mm was found for the tracer's path along the shell, {}",
                                    1e3 * known.context.mill_radius, interval_text(motion.path_radius, 1e3),
                                    bead_known ? "and a bead's radius added" : "and the bead's radius, which would add to it, is unknown"));
}

}  // namespace

RecordedMill stated_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill) {
  RecordedMill known;
  known.context = stated(recording, mill);
  if (recording.frame) known.axis = recording.frame->axis;
  weigh_charge(recording.condition, known.context);
  return known;
}

RecordedMill know_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill) {
  return know_mill(recording, mill, inspect::estimate_motion(recording));
}

RecordedMill know_mill(const recording::Recording& recording, const std::optional<MillOfCase>& mill, const inspect::MillMotion& motion) {
  RecordedMill known = stated_mill(recording, mill);
  if (!recording.frame) find_axis(recording, motion, known);
  check_speed(recording, motion, known);
  if (known.context.omega == 0) find_speed(recording, motion, known);
  if (!(known.context.mill_radius > 0)) find_radius(motion, known);
  if (recording.condition.mill_length && !(known.context.mill_high > known.context.mill_low)) {
    known.notes.push_back("where the end faces stand along z is not known: give 'ends' in the recording's frame");
  }
  weigh_charge(recording.condition, known.context);
  return known;
}

}  // namespace millscope::analysis
