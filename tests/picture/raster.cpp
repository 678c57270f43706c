#include "raster.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace picture_test {

Raster::Spot Raster::find(std::uint32_t color) const {
  Spot spot;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (at(x, y) != color) continue;
      ++spot.count;
      spot.x += x, spot.y += y;
      spot.left = std::min(spot.left, x), spot.right = std::max(spot.right, x);
      spot.top = std::min(spot.top, y), spot.bottom = std::max(spot.bottom, y);
    }
  }
  if (spot.count > 0) spot.x /= spot.count, spot.y /= spot.count;
  return spot;
}

bool Raster::has_white_margin(int ring) const {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool in_ring = x < ring || y < ring || x >= width - ring || y >= height - ring;
      if (in_ring && at(x, y) != 0xffffff) return false;
    }
  }
  return true;
}

Raster read_png(const std::filesystem::path& path) {
  cairo_surface_t* surface = cairo_image_surface_create_from_png(path.c_str());
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("no PNG: " + path.string());
  Raster raster{cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
  const unsigned char* data = cairo_image_surface_get_data(surface);
  for (int y = 0; y < raster.height; ++y) {
    const auto* line =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface));
    for (int x = 0; x < raster.width; ++x) raster.pixel.push_back(line[x] & 0xffffff);
  }
  cairo_surface_destroy(surface);
  return raster;
}

std::uint32_t to_pixel(const millscope::picture::Color& color) {
  const auto byte = [](double part) { return static_cast<std::uint32_t>(std::lround(255 * part)); };
  return (byte(color.red) << 16) | (byte(color.green) << 8) | byte(color.blue);
}

double lightness(const millscope::picture::Color& color) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const double y = 0.2126 * linear(color.red) + 0.7152 * linear(color.green) + 0.0722 * linear(color.blue);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

}  // namespace picture_test
