// Numbers for people: units with prefixes, round ticks, axes.
#pragma once

#include <string>
#include <vector>

namespace millscope::picture {

/// What a stored value is multiplied by, and the unit that then stands beside it.
struct DisplayUnit {
  double factor = 1;
  std::string text;  ///< "mm", "%", "10⁻³ m²/s²"; empty: a bare number
};

/// A unit in which `largest` (the largest magnitude to be shown, in `unit`) reads well: lengths below 10 m in mm, small fractions in %,
/// other SI units with the prefix that leaves 0.1 to 1000, else a power of ten in front.
DisplayUnit display_unit(const std::string& unit, double largest);

/// Typeset: "m^2/s^2" → "m²/s²"; "1" → "".
std::string typeset_unit(const std::string& unit);

/// "speed" and "m/s" → "speed (m/s)".
std::string with_unit(const std::string& label, const std::string& unit);

/// With as many decimals as a step needs, and a true minus sign.
std::string number_text(double value, double step);

/// With `digits` significant digits, no exponent between 1e-4 and 1e6, and a true minus sign; "–" for NaN.
std::string significant_text(double value, int digits);

/// Where an axis is labelled.
struct Ticks {
  std::vector<double> major;  ///< in displayed units
  std::vector<std::string> label;
  std::vector<double> minor;
};

/// Multiples of 1, 2 or 5 · 10ⁿ within [low, high], at most `most` of them.
Ticks even_ticks(double low, double high, int most);

/// Decades, and 2 and 5 times them where there are few, within [low, high]; minor ticks at the other digits.
Ticks logarithmic_ticks(double low, double high, int most);

/// One axis in displayed units.
struct Axis {
  std::string label;  ///< with the unit
  double factor = 1;  ///< stored value → displayed
  double low = 0, high = 1;
  bool logarithmic = false;
  Ticks ticks;

  /// 0 at `low`, 1 at `high`, for a value as it is stored; NaN where a logarithmic axis has no place for it.
  double place(double stored) const;
};

/// An axis from `low` to `high` (stored values); ticks for about `length` points of paper.
Axis make_axis(const std::string& label, const std::string& unit, double low, double high, bool logarithmic, double length);

}  // namespace millscope::picture
