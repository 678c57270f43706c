// What analyzers ask of the mill: its shell, its turning sense, the part of its length that is looked at. What is unknown is refused
// with the remedy, never guessed.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "millscope/analyzer_adapter.hpp"

namespace millscope::analyzers {

inline constexpr double kDegrees = 180 / std::numbers::pi;  ///< degrees in one radian

/// +1: counter-clockwise about z, −1: clockwise, 0: unknown.
inline double turning_sense(const AnalyzerContext& context) { return context.omega > 0 ? 1.0 : context.omega < 0 ? -1.0 : 0.0; }

/// Radius of the bare shell, m.
inline double shell_radius(const AnalyzerContext& context) {
  if (!(context.mill_radius > 0)) {
    throw Refusal(
        "the radius of the mill is unknown: give the condition's mill_diameter in the recording's YAML, or the mill's in the case");
  }
  return context.mill_radius;
}

/// ±1; refuses where the sense is unknown.
inline double known_sense(const AnalyzerContext& context) {
  const double sense = turning_sense(context);
  if (sense == 0) {
    throw Refusal("the turning speed of the mill is unknown or zero: give the condition's speed and direction in the recording's YAML");
  }
  return sense;
}

/// The mill's inner length, m; 0: unknown. It may be known where the places of the end faces are not.
inline double known_length(const AnalyzerContext& context) {
  return context.mill_length > 0 ? context.mill_length : std::fmax(0, context.mill_high - context.mill_low);
}

/// Range along the axis that is looked at, as the options say.
struct AxialRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  ///< m
  double length = 0;                                                                                      ///< m; 0: unknown
  bool contains(double z) const { return z >= low && z <= high; }
};

inline constexpr Parameter kAxialFrom = optional(
    number_parameter("z_from", "m", kRequired, -kUnbounded, kUnbounded, "Look at z not below this only; without it from the end face."));
inline constexpr Parameter kAxialTo = optional(
    number_parameter("z_to", "m", kRequired, -kUnbounded, kUnbounded, "Look at z not above this only; without it to the end face."));
inline constexpr Parameter kEndTrim =
    number_parameter("end_trim", "m", 0, 0, kUnbounded, "Left out at each end face; Chagas 2015 leaves out 50 mm of 270 mm.");

/// The three options above; refuses ranges that are empty or that need end faces which are unknown. Without options every bead counts,
/// also one that a camera's noise puts beyond an end face.
inline AxialRange axial_range(const Parameters& parameters, const AnalyzerContext& context) {
  const bool from = parameters.given("z_from"), to = parameters.given("z_to"), faces = context.mill_high > context.mill_low;
  const double trim = parameters.number("end_trim");
  AxialRange range;
  if (faces) range.length = context.mill_high - context.mill_low;
  if (trim > 0 && (from || to)) throw Refusal("give end_trim, or z_from and z_to, not both");
  if (trim > 0 && !faces)
    throw Refusal("end_trim needs the end faces, which are unknown: give z_from and z_to instead, or 'ends' in the recording's frame");
  if (!from && !to && trim == 0) return range;
  range.low = from ? parameters.number("z_from") : faces ? context.mill_low + trim : range.low;
  range.high = to ? parameters.number("z_to") : faces ? context.mill_high - trim : range.high;
  if (!(range.high > range.low)) {
    throw Refusal("the range along z is empty: from " + std::to_string(range.low) + " m to " + std::to_string(range.high) + " m");
  }
  range.length = std::isfinite(range.high - range.low) ? range.high - range.low : 0;
  return range;
}

}  // namespace millscope::analyzers
