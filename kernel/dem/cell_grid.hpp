// A grid of cells no smaller than the largest distance at which two beads are listed: all neighbours of a bead are in the cells round its
// own.
#pragma once

#include <array>
#include <vector>

#include "kernel/dem/common.hpp"

namespace millscope::dem {

/// Of all beads at a rebuild.
struct Extent {
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};  ///< of the centres, m
  double reach = 0;                                                           ///< the largest, m
};

/// The beads in a cell and in those round it: ranges in ascending order, joined where they follow one another.
struct Neighbourhood {
  std::array<BeadRange, 18> ranges;  // nine rows, each of one piece or, at a periodic end, two
  int count = 0;
  std::int64_t beads = 0;

  void add(BeadRange range);
};

class CellGrid {
 public:
  /// Chooses the cells: at most about four a bead.
  void fit(const Settings& settings, const Extent& extent, std::int64_t beads);
  std::uint32_t cell_of(const PositionLine& bead) const;
  /// Turns the cells of all beads into their numbers in the order of cells; beads of one cell keep their order.
  void number(std::vector<std::uint32_t>& cells_of_beads);

  /// Cell of a bead by its new number.
  std::int64_t cell_at(std::int64_t bead) const;
  std::int64_t end_of(std::int64_t cell) const { return start_[cell + 1]; }
  /// Of a cell, without the ranges that lie behind it.
  Neighbourhood round(std::int64_t cell) const;

 private:
  void choose_axes(const Settings& settings);

  double low_[3];
  double inverse_edge_[3];
  int cells_[3];
  bool periodic_[3];
  int axis_[3];                       ///< axis_[0] is the slowest in the order of cells
  std::vector<std::uint32_t> start_;  ///< [cell]: number of its first bead; one more at the end
};

}  // namespace millscope::dem
