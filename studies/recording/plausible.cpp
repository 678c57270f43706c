#include "studies/recording/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kernel/base/statistics.hpp"
#include "studies/recording/clean.hpp"

namespace millscope::recording {
namespace {

constexpr const char* kNoUnit = "check the columns and the units; no usual unit makes sense of them";
constexpr double kLargestMill = 20;       // m, across; the largest mills have 13 m
constexpr double kSmallestMill = 0.005;   // m
constexpr double kFalls = 3;              // times √(2 g D)
constexpr double kLongestInterval = 0.5;  // s; a point now and then shows no motion

/// What is measured, in the units as they were taken.
struct Measured {
  double across = 0, along = 0;  // m
  double speed = 0;              // m/s, 99th percentile
  double usual_speed = 0;        // m/s, 95th percentile; outliers do not reach it
  double noise = 0;              // m
  double interval = 0;           // s, median
  double spread = 0;             // m, the tracker's own, median; 0 where there is none
  double farthest = 0;           // m, of the middle from the origin along an axis
  bool moves() const { return across > 10 * noise; }
};

struct Scale {
  const char* unit;
  double si;
};
constexpr std::array<Scale, 4> kLengths{{{"mm", 1e-3}, {"m", 1}, {"cm", 1e-2}, {"um", 1e-6}}};
constexpr std::array<Scale, 4> kTimes{{{"ms", 1e-3}, {"s", 1}, {"us", 1e-6}, {"min", 60}}};

bool fits(double across, double speed, double interval, const Condition& condition) {
  if (interval > kLongestInterval) return false;
  if (across > kLargestMill || across < kSmallestMill) return false;
  if (condition.mill_diameter && (across > 1.5 * *condition.mill_diameter || across < *condition.mill_diameter / 20)) return false;
  const double fall = fall_speed(condition.mill_diameter.value_or(across));
  return speed < kFalls * fall && speed > 2e-3 * fall;
}

template <std::size_t n>
double scale_of(const std::array<Scale, n>& scales, const std::string& unit) {
  const auto found = std::find_if(scales.begin(), scales.end(), [&](const Scale& scale) { return unit == scale.unit; });
  return found == scales.end() ? 0 : found->si;
}

/// The change of one unit, else of both, that makes sense of the numbers; nothing: none does.
std::optional<std::string> hint(const Measured& m, const Condition& condition, const std::string& time_unit,
                                const std::string& length_unit) {
  const double length = scale_of(kLengths, length_unit), time = scale_of(kTimes, time_unit);
  if (length == 0 || time == 0) return "check the units";
  const auto works = [&](const Scale& l, const Scale& t) {
    return m.farthest * l.si / length < kLargestMill &&
           fits(m.across * l.si / length, m.usual_speed * (l.si / length) / (t.si / time), m.interval * t.si / time, condition);
  };
  const Scale now_length{length_unit.c_str(), length}, now_time{time_unit.c_str(), time};
  const auto say_length = [&](const Scale& l) { return fmt::format("x, y, z are probably in {}, not {}", l.unit, length_unit); };
  const auto say_time = [&](const Scale& t) { return fmt::format("t is probably in {}, not {}", t.unit, time_unit); };
  for (const Scale& l : kLengths) {
    if (l.si != length && works(l, now_time))
      return fmt::format("{}: say 'columns: {{x: {}, y: {}, z: {}, …}}' in a recording.yaml", say_length(l), l.unit, l.unit, l.unit);
  }
  for (const Scale& t : kTimes) {
    if (t.si != time && works(now_length, t))
      return fmt::format("{}: say 'columns: {{t: {}, …}}' in a recording.yaml", say_time(t), t.unit);
  }
  for (const Scale& l : kLengths) {
    for (const Scale& t : kTimes) {
      if (l.si != length && t.si != time && works(l, t))
        return fmt::format("{}, and {}: say so under 'columns' in a recording.yaml", say_length(l), say_time(t));
    }
  }
  return std::nullopt;
}

Measured measure(const std::vector<Run>& runs, double gap_limit) {
  const Extent extent = measure_extent(runs);
  Measured m{extent.across(), extent.width[2], speed_quantile(runs, 0.99), speed_quantile(runs, 0.95), 0, median_interval(runs)};
  m.noise = measure_travel(runs, gap_limit).noise;
  std::vector<double> spread = runs.empty() ? std::vector<double>() : runs[0].spread;
  if (!spread.empty()) m.spread = base::quantile(spread, 0.5);
  for (const double middle : extent.middle) m.farthest = std::max(m.farthest, std::fabs(middle));
  return m;
}

std::string in_millimetres(double length) { return fmt::format("say the unit, e.g. {:.4g} mm", length); }

/// What `condition` says of beads and of the mill's length, against the points.
void check_condition(const Measured& m, const Condition& condition, const base::Location& where) {
  constexpr double kLargestBead = 1.0 / 3;  // of the points' width
  constexpr double kLongest = 50;           // times what the tracer saw of it
  const auto check_bead = [&](const char* key, const std::optional<double>& diameter) {
    if (!diameter || !m.moves() || *diameter <= kLargestBead * m.across) return;
    throw base::UserError(where, fmt::format("'{}' of 'condition' is {:.4g} m, but the bead moves within {:.3g} m across; {}", key,
                                             *diameter, m.across, in_millimetres(*diameter)));
  };
  check_bead("bead_diameter", condition.bead_diameter);
  check_bead("tracer: diameter", condition.tracer.diameter);
  const std::optional<double>& length = condition.mill_length;
  if (!length || m.along < 10 * m.noise) return;
  if (m.along > 1.5 * *length || *length > kLongest * m.along) {
    throw base::UserError(where,
                          fmt::format("'mill_length' of 'condition' is {:.4g} m, but the points span {:.3g} m along z; correct it ({}), "
                                      "or the axes",
                                      *length, m.along, in_millimetres(*length)));
  }
}

}  // namespace

void check_units(const std::vector<Run>& runs, const Condition& condition, const base::Location& where, const std::string& time_unit,
                 const std::string& length_unit) {
  const Measured m = measure(runs, default_gap_limit(runs));
  const auto refuse = [&](const std::string& what) {
    throw base::UserError(where, fmt::format("{}; {}", what, hint(m, condition, time_unit, length_unit).value_or(kNoUnit)));
  };
  if (m.across > kLargestMill || m.along > 2 * kLargestMill) {
    refuse(fmt::format("the points span {:.4g} m across and {:.4g} m along z, and no mill is that large", m.across, m.along));
  }
  const bool small = m.moves() && m.across < kSmallestMill;
  // A tracer at rest drifts by less than its own spread, and no unit makes a mill of it: smoothed points hide that it is noise.
  if (small && (m.spread > m.across || !hint(m, condition, time_unit, length_unit))) return;
  if (small) {
    refuse(fmt::format("the points move within {:.3g} m across, and no mill is that small", m.across));
  }
  if (condition.mill_diameter && (m.across > 1.5 * *condition.mill_diameter || (m.moves() && m.across < *condition.mill_diameter / 100))) {
    refuse(fmt::format("the points span {:.4g} m across, but the mill's diameter is {:.4g} m", m.across, *condition.mill_diameter));
  }
  if (m.interval > kLongestInterval) {
    refuse(fmt::format("the points lie {:.3g} s apart (median), and no motion in a mill can be followed so", m.interval));
  }
  const double diameter = std::max(m.across, condition.mill_diameter.value_or(0)), limit = kFalls * fall_speed(diameter);
  if (m.speed > limit && m.usual_speed > limit / 3) {
    refuse(fmt::format("one per cent of the points is faster than {:.4g} m/s, but a fall across {:.3g} m gives no more than {:.3g} m/s",
                       m.speed, diameter, limit / kFalls));
  }
  check_condition(m, condition, where);
}

}  // namespace millscope::recording
