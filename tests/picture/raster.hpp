// Reads a PNG back, so that tests judge what a person would see.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "studies/picture/color.hpp"

namespace picture_test {

struct Raster {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixel;  ///< 0xRRGGBB, row by row from the top
  std::uint32_t at(int x, int y) const {
    return pixel[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  /// How many pixels have exactly this colour, and where their middle is (from the left and the top).
  struct Spot {
    int count = 0;
    double x = 0, y = 0;
    int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1;
  };
  Spot find(std::uint32_t color) const;
  /// Whether the outermost `ring` pixels are white: nothing is cut off.
  bool has_white_margin(int ring) const;
};

Raster read_png(const std::filesystem::path& path);

std::uint32_t to_pixel(const millscope::picture::Color& color);

/// CIE L* of a colour, 0…100: how light it looks.
double lightness(const millscope::picture::Color& color);

}  // namespace picture_test
