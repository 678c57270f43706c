#include "studies/picture/scale.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

namespace millscope::picture {
namespace {

constexpr std::string_view kMinus = "\u2212";

std::string superscript(int number) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) text += digits[c - '0'];
  return text;
}

std::string proper_minus(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, kMinus);
  return text;
}

/// The unit symbol at the front that may take a prefix ("W" of "W/m"); empty: none ("m^2", "rad/s", "kg").
std::string prefixable(const std::string& unit) {
  constexpr std::array<const char*, 6> symbols{"m", "W", "J", "s", "N", "Pa"};
  const std::size_t end = std::min(unit.find_first_of("/ *^²³·"), unit.size());
  const std::string front = unit.substr(0, end);
  const bool plain = end == unit.size() || unit[end] == '/' || unit[end] == ' ';
  return plain && std::find(symbols.begin(), symbols.end(), front) != symbols.end() ? front : "";
}

DisplayUnit with_prefix(const std::string& unit, double largest) {
  constexpr std::array<std::pair<double, const char*>, 7> prefixes{
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};
  for (const auto& [size, prefix] : prefixes) {
    if (largest >= size * (size == 1 ? 0.1 : 1)) return {1 / size, fmt::format("{}{}", prefix, typeset_unit(unit))};
  }
  return {1e9, fmt::format("n{}", typeset_unit(unit))};
}

DisplayUnit with_power_of_ten(const std::string& unit, double largest) {
  if (largest >= 0.01 && largest < 1e5) return {1, typeset_unit(unit)};
  const int exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  const std::string bare = typeset_unit(unit);
  return {std::pow(10, -exponent), fmt::format("10{}{}{}", superscript(exponent), bare.empty() ? "" : " ", bare)};
}

}  // namespace

std::string typeset_unit(const std::string& unit) {
  if (unit == "1") return "";
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '^') {
      std::size_t used = 0;
      const std::string rest = unit.substr(i + 1);
      if (!rest.empty() && (std::isdigit(static_cast<unsigned char>(rest[0])) || rest[0] == '-')) {
        text += superscript(std::stoi(rest, &used));
        i += used;
        continue;
      }
    }
    text += unit[i] == '*' ? std::string("·") : std::string(1, unit[i]);
  }
  return text;
}

DisplayUnit display_unit(const std::string& unit, double largest) {
  if (!(largest > 0) || !std::isfinite(largest)) return {1, typeset_unit(unit)};
  if (unit == "m" && largest < 10 && largest >= 1e-4) return {1e3, "mm"};
  if (unit == "1" && largest <= 0.3 && largest >= 1e-5) return {100, "%"};
  if (unit == "kg" && largest < 0.1) return {1e3, "g"};
  if (unit == "deg") return {1, "°"};
  if (unit == "rad") return {180 / std::numbers::pi, "°"};
  if (!prefixable(unit).empty()) return with_prefix(unit, largest);
  return with_power_of_ten(unit, largest);
}

std::string with_unit(const std::string& label, const std::string& unit) { return unit.empty() ? label : label + " (" + unit + ")"; }

std::string number_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double shown = std::abs(value) < 1e-9 * step ? 0 : value;
  return proper_minus(fmt::format("{:.{}f}", shown, decimals));
}

std::string significant_text(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (value == 0 || !std::isfinite(value)) return proper_minus(fmt::format("{}", value));
  const double magnitude = std::abs(value);
  if (magnitude < 1e-4 || magnitude >= 1e6) return proper_minus(fmt::format("{:.{}e}", value, digits - 1));
  const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(magnitude))));
  return proper_minus(fmt::format("{:.{}f}", value, decimals));
}

Ticks even_ticks(double low, double high, int most) {
  Ticks ticks;
  const double span = high - low;
  // A map that is constant but for rounding has no ticks; nor could multiples of so small a step be told apart.
  if (!(span > 1e-12 * std::max(std::abs(low), std::abs(high))) || !std::isfinite(span)) return ticks;
  double step = std::pow(10, std::floor(std::log10(span)) - 2);
  for (int round = 0; span / step > most; ++round) step *= round % 3 == 1 ? 2.5 : 2;  // 1, 2, 5, 10
  for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n += 1) {
    ticks.major.push_back(n * step);
    ticks.label.push_back(number_text(n * step, step));
  }
  return ticks;
}

Ticks logarithmic_ticks(double low, double high, int most) {
  Ticks ticks;
  const int first = static_cast<int>(std::floor(std::log10(low))), last = static_cast<int>(std::ceil(std::log10(high)));
  const double decades = std::log10(high / low);
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / most)));
  const bool between = decades * 3 <= most;
  const bool plain = low >= 0.9e-3 && high < 1.1e5;
  for (int decade = first; decade <= last; ++decade) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10, decade);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      const bool labelled = digit == 1 ? decade % stride == 0 : between && (digit == 2 || digit == 5);
      if (!labelled) {
        if (stride == 1) ticks.minor.push_back(value);
        continue;
      }
      ticks.major.push_back(value);
      ticks.label.push_back(plain ? number_text(value, std::pow(10, std::min(decade, 0)))
                                  : (digit == 1 ? "" : fmt::format("{}·", digit)) + "10" + superscript(decade));
    }
  }
  return ticks;
}

double Axis::place(double stored) const {
  const double value = stored * factor;
  if (!logarithmic) return (value - low) / (high - low);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log(value / low) / std::log(high / low);
}

Axis make_axis(const std::string& label, const std::string& unit, double low, double high, bool logarithmic, double length) {
  DisplayUnit shown = display_unit(unit, std::max(std::abs(low), std::abs(high)));
  if (logarithmic && unit != "m") shown = {1, typeset_unit(unit)};  // its ticks are powers of ten anyway
  Axis axis{with_unit(label, shown.text), shown.factor, low * shown.factor, high * shown.factor, logarithmic, {}};
  const int most = std::max(2, static_cast<int>(length / 38));
  axis.ticks = logarithmic ? logarithmic_ticks(axis.low, axis.high, most) : even_ticks(axis.low, axis.high, most);
  return axis;
}

}  // namespace millscope::picture
