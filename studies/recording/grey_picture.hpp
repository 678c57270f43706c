// A picture as greys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace millscope::recording {

struct GreyPicture {
  int width = 0, height = 0;         ///< pixels
  std::vector<std::uint8_t> pixels;  ///< row by row from the top, 0 black … 255 white
  double at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// PNG, BMP, JPEG, binary PGM; colours become their luminance, what is transparent counts as if it were not. Nothing: the file is no such
/// picture.
std::optional<GreyPicture> read_grey_picture(const std::filesystem::path& file);

}  // namespace millscope::recording
