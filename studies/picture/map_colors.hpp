// Which colour a value of a map has. The page has the same rule in page/src/colours.js; tests/picture/colours.json holds both.
#pragma once

#include <cmath>

#include "studies/picture/color.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::picture {

/// No data, or exactly zero: never visited.
inline bool is_blank(double value) { return !std::isfinite(value) || value == 0; }

/// From values to colours, in stored units.
struct MapColors {
  double low = 0, high = 1;          // ends of the bar
  double smallest = 0, largest = 0;  // of the data
  bool diverging = false, any = false, named = false;

  Color operator()(double value) const;
  // A rounding error beyond the end is no value beyond the end.
  bool beyond_high() const { return largest > high + 1e-9 * (high - low); }
  bool beyond_low() const { return smallest < low - 1e-9 * (high - low); }
};

MapColors choose_colors(const MapPicture& picture);

}  // namespace millscope::picture
