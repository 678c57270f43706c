#include "geometry/mesh/near_grid.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::geometry {

namespace {

/// 2 MB of bits: they stay in the second-level cache.
constexpr double kMaxCells = 16.0 * 1024 * 1024;

Bounds box_of(const TriangleRecord& t) {
  const Point b = t.a + t.e, c = t.a + t.f;
  return {{std::min({t.a.x, b.x, c.x}), std::min({t.a.y, b.y, c.y}), std::min({t.a.z, b.z, c.z})},
          {std::max({t.a.x, b.x, c.x}), std::max({t.a.y, b.y, c.y}), std::max({t.a.z, b.z, c.z})}};
}

}  // namespace

void NearGrid::choose_cells(const Bounds& box, double distance) {
  const Point reach{distance, distance, distance};
  low_ = box.low - reach;
  const Point extent = box.high + reach - low_;
  cell_ = std::max(0.5 * distance, std::cbrt(extent.x * extent.y * extent.z / kMaxCells));
  const double x[3] = {extent.x, extent.y, extent.z};
  for (int k = 0; k < 3; ++k) {
    cells_[k] = static_cast<std::uint64_t>(x[k] / cell_) + 1;
    size_[k] = static_cast<double>(cells_[k]);
  }
  inverse_ = 1 / cell_;
  bits_.assign((cells_[0] * cells_[1] * cells_[2] + 63) / 64, 0);
}

void NearGrid::mark(const TriangleRecord& t, double distance) {
  const Bounds box = box_of(t);
  const double start[3] = {box.low.x - low_.x, box.low.y - low_.y, box.low.z - low_.z};
  const double stop[3] = {box.high.x - low_.x, box.high.y - low_.y, box.high.z - low_.z};
  std::uint64_t from[3], to[3];
  for (int k = 0; k < 3; ++k) {
    from[k] = static_cast<std::uint64_t>(std::max(0.0, (start[k] - distance) * inverse_));
    to[k] = std::min(cells_[k] - 1, static_cast<std::uint64_t>(std::max(0.0, (stop[k] + distance) * inverse_)));
  }
  const double limit = distance + 0.5 * std::sqrt(3.0) * cell_;  // from the middle of a cell
  for (std::uint64_t k = from[2]; k <= to[2]; ++k) {
    for (std::uint64_t j = from[1]; j <= to[1]; ++j) {
      for (std::uint64_t i = from[0]; i <= to[0]; ++i) {
        const std::uint64_t cell = (k * cells_[1] + j) * cells_[0] + i;
        if ((bits_[cell >> 6] >> (cell & 63)) & 1U) continue;
        const Point middle = low_ + cell_ * Point{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5, static_cast<double>(k) + 0.5};
        const double height = height_above(t, middle);
        if (std::fabs(height) > limit || nearest_point(t, middle, height).squared > limit * limit) continue;
        bits_[cell >> 6] |= std::uint64_t{1} << (cell & 63);
      }
    }
  }
}

void NearGrid::prepare(const std::vector<TriangleRecord>& records, double distance) {
  if (distance <= prepared_ || records.empty()) return;
  prepared_ = 1.1 * distance;  // a little room, so that a growing margin does not rebuild it each time
  Bounds box = box_of(records[0]);
  for (const TriangleRecord& t : records) {
    const Bounds b = box_of(t);
    box.low = {std::min(box.low.x, b.low.x), std::min(box.low.y, b.low.y), std::min(box.low.z, b.low.z)};
    box.high = {std::max(box.high.x, b.high.x), std::max(box.high.y, b.high.y), std::max(box.high.z, b.high.z)};
  }
  choose_cells(box, prepared_);
  for (const TriangleRecord& t : records) mark(t, prepared_);
}

}  // namespace millscope::geometry
