// Equal bins along one coordinate, and the means that they hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "millscope/element.hpp"

namespace millscope::analyzers {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// `count` equal bins from `low` to `high`; the last one includes `high`.
struct Bins {
  double low = 0, high = 1;
  std::int64_t count = 1;
  double per_unit = 1;  ///< bins per unit of the coordinate

  Bins() = default;
  Bins(double from, double to, std::int64_t bins) : low(from), high(to), count(bins), per_unit(static_cast<double>(bins) / (to - from)) {}

  /// Number of the bin that holds `value`; none outside and for NaN.
  std::optional<std::int64_t> at(double value) const {
    const double place = (value - low) * per_unit;
    if (!(place >= 0 && value <= high)) return std::nullopt;
    return std::min(static_cast<std::int64_t>(place), count - 1);  // at `high`, place may round to more than count
  }
  /// 0: below; 1 … count: bin + 1; count + 1: above (and NaN).
  std::int64_t slot(double value) const {
    if ((value - low) * per_unit < 0) return 0;
    return at(value).value_or(count) + 1;
  }
  double width() const { return (high - low) / static_cast<double>(count); }
  double edge(std::int64_t i) const { return i == count ? high : low + static_cast<double>(i) * width(); }
  double centre(std::int64_t i) const { return low + (static_cast<double>(i) + 0.5) * width(); }
  /// count + 1 numbers, each multiplied by `factor` (for another unit).
  std::vector<double> edges(double factor = 1) const {
    std::vector<double> all(as_size(count) + 1);
    for (std::int64_t i = 0; i <= count; ++i) element(all, i) = factor * edge(i);
    return all;
  }
};

/// Number of the cell that holds (x, y) in a square of bins, row by row along y; none outside.
inline std::optional<std::int64_t> cell_at(const Bins& bins, double x, double y) {
  const std::optional<std::int64_t> column = bins.at(x), row = bins.at(y);
  if (!column || !row) return std::nullopt;
  return *row * bins.count + *column;
}

/// sum/weight; NaN where nothing was seen.
inline double ratio(double sum, double weight) { return weight > 0 ? sum / weight : kNaN; }

/// Area of a rectangle that lies inside the circle of that radius about the origin, m².
inline double area_in_circle(double x0, double x1, double y0, double y1, double radius) {
  const auto farthest = [](double a, double b) { return std::fmax(std::fabs(a), std::fabs(b)); };
  if (std::hypot(farthest(x0, x1), farthest(y0, y1)) <= radius) return (x1 - x0) * (y1 - y0);
  constexpr int kStrips = 512;  // 1e-5 of a cell
  const double width = (x1 - x0) / kStrips;
  double area = 0;
  for (int strip = 0; strip < kStrips; ++strip) {
    const double x = x0 + (strip + 0.5) * width, square = radius * radius - x * x;
    if (square <= 0) continue;
    const double half = std::sqrt(square);
    area += std::fmax(0.0, std::fmin(y1, half) - std::fmax(y0, -half)) * width;
  }
  return area;
}

}  // namespace millscope::analyzers
