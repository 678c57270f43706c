#include "studies/picture/color.hpp"

#include <algorithm>
#include <cmath>

#include "studies/picture/palette.hpp"

namespace millscope::picture {
namespace {

Color from_hex(std::uint32_t rgb) {
  return {static_cast<double>(rgb >> 16) / 255, static_cast<double>((rgb >> 8) & 255) / 255, static_cast<double>(rgb & 255) / 255, 1};
}

template <std::size_t knots>
Color interpolate(const std::array<std::uint32_t, knots>& table, double fraction) {
  const double place = std::clamp(fraction, 0.0, 1.0) * (knots - 1);
  const std::size_t knot = std::min(static_cast<std::size_t>(place), knots - 2);
  const double part = place - static_cast<double>(knot);
  const Color a = from_hex(table[knot]), b = from_hex(table[knot + 1]);
  return {std::lerp(a.red, b.red, part), std::lerp(a.green, b.green, part), std::lerp(a.blue, b.blue, part), 1};
}

}  // namespace

Color sequential_color(double fraction) { return interpolate(kSequential, fraction); }

Color diverging_color(double fraction) { return interpolate(kDiverging, fraction); }

Color distinct_color(std::size_t index) { return from_hex(kDistinct[index % kDistinct.size()]); }

}  // namespace millscope::picture
