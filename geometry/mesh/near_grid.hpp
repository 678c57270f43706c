// A cheap answer to "surely far from every triangle?": one bit per cell of a grid over the mesh. Most beads of a charge are far, and
// each costs one look-up at a rebuild.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_record.hpp"

namespace millscope::geometry {

class NearGrid {
 public:
  /// Makes the grid good for beads of radius + margin up to `distance`; does nothing when it is already.
  void prepare(const std::vector<TriangleRecord>& records, double distance);

  /// False: no triangle is within the prepared distance.
  bool is_near(double x, double y, double z) const {
    const double fx = (x - low_.x) * inverse_, fy = (y - low_.y) * inverse_, fz = (z - low_.z) * inverse_;
    if (!(fx >= 0 && fy >= 0 && fz >= 0 && fx < size_[0] && fy < size_[1] && fz < size_[2])) return false;
    const auto cell =
        (static_cast<std::uint64_t>(fz) * cells_[1] + static_cast<std::uint64_t>(fy)) * cells_[0] + static_cast<std::uint64_t>(fx);
    return (bits_[cell >> 6] >> (cell & 63)) & 1U;
  }

 private:
  void choose_cells(const Bounds& box, double distance);
  void mark(const TriangleRecord& t, double distance);

  Point low_{0, 0, 0};
  double inverse_ = 0, cell_ = 0, prepared_ = -1;
  double size_[3] = {0, 0, 0};  // cells_ as doubles
  std::uint64_t cells_[3] = {0, 0, 0};
  std::vector<std::uint64_t> bits_;
};

}  // namespace millscope::geometry
