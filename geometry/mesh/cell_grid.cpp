#include "geometry/mesh/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::geometry {

namespace {

/// 4 MB of entries. Smaller cells give shorter lists, but most beads are far from the wall and each look-up of theirs should stay cheap.
constexpr double kMaxCells = 1024 * 1024;

}  // namespace

void CellGrid::prepare(const Bounds& box, double distance) {
  const Point reach{distance, distance, distance};
  low_ = box.low - reach;
  const Point extent = box.high + reach - low_;
  cell_ = std::max(0.5 * distance, std::cbrt(extent.x * extent.y * extent.z / kMaxCells));
  half_diagonal_ = 0.5 * std::sqrt(3.0) * cell_;
  inverse_ = 1 / cell_;
  const double x[3] = {extent.x, extent.y, extent.z};
  for (int k = 0; k < 3; ++k) {
    cells_[k] = static_cast<std::uint64_t>(x[k] * inverse_) + 1;
    size_[k] = static_cast<double>(cells_[k]);
  }
  std::size_t shorter_first[3] = {0, 1, 2};
  std::stable_sort(shorter_first, shorter_first + 3, [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::uint64_t entries = 1;
  for (const std::size_t k : shorter_first) {
    stride_[k] = entries;
    entries *= cells_[k];
  }
  entries_.assign(entries, 0);
}

Point CellGrid::middle_of(std::uint64_t cell) const {
  const std::uint64_t i = cell / stride_[0] % cells_[0], j = cell / stride_[1] % cells_[1], k = cell / stride_[2] % cells_[2];
  return low_ + cell_ * Point{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5, static_cast<double>(k) + 0.5};
}

}  // namespace millscope::geometry
