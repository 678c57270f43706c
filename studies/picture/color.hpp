// Colours: perceptually even, legible without colour vision and in grey print.
#pragma once

#include <cstddef>

namespace millscope::picture {

/// sRGB, each 0…1.
struct Color {
  double red = 0, green = 0, blue = 0, alpha = 1;
};

/// viridis: fraction 0 dark, 1 bright; outside it is held at the end.
Color sequential_color(double fraction);

/// Cool to warm through light grey: 0 blue, ½ neutral, 1 red.
Color diverging_color(double fraction);

/// Unlike colours for curves and names; repeats after eight.
Color distinct_color(std::size_t index);

}  // namespace millscope::picture
