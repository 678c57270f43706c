// A grid over the mesh, one number per cell: what is known of the triangles near the cell.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

class CellGrid {
 public:
  static constexpr std::uint64_t kOutside = ~std::uint64_t{0};

  /// Cells for beads of radius + margin up to `distance` about a mesh in `box`; every entry becomes 0.
  void prepare(const Bounds& box, double distance);

  /// kOutside: farther than the prepared distance from the box.
  std::uint64_t cell_of(const Point& p) const {
    const double fx = (p.x - low_.x) * inverse_, fy = (p.y - low_.y) * inverse_, fz = (p.z - low_.z) * inverse_;
    if (!(fx >= 0 && fy >= 0 && fz >= 0 && fx < size_[0] && fy < size_[1] && fz < size_[2])) return kOutside;
    return static_cast<std::uint64_t>(fx) * stride_[0] + static_cast<std::uint64_t>(fy) * stride_[1] +
           static_cast<std::uint64_t>(fz) * stride_[2];
  }
  Point middle_of(std::uint64_t cell) const;
  double half_diagonal() const { return half_diagonal_; }
  /// Asks for an entry ahead of its use.
  void fetch(std::uint64_t cell) const { __builtin_prefetch(cell == kOutside ? entries_.data() : &entries_[cell]); }
  std::uint32_t entry(std::uint64_t cell) const { return entries_[cell]; }
  std::uint32_t& entry(std::uint64_t cell) { return entries_[cell]; }

 private:
  Point low_{0, 0, 0};
  double inverse_ = 0, cell_ = 0, half_diagonal_ = 0;
  double size_[3] = {0, 0, 0};  // cells_ as doubles
  std::uint64_t cells_[3] = {0, 0, 0};
  std::uint64_t stride_[3] = {0, 0, 0};  // largest along the longest side, as the beads are sorted: neighbours ask neighbours
  std::vector<std::uint32_t> entries_;
};

}  // namespace millscope::geometry
