#include "kernel/dem/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace millscope::dem {
namespace {

/// A coordinate of a cell and its distinct neighbours, ascending. Returns how many they are.
int around(int c, int count, bool periodic, int (&out)[3]) {
  int m = 0;
  if (periodic && c == count - 1 && count > 2) out[m++] = 0;
  if (c > 0) out[m++] = c - 1;
  out[m++] = c;
  if (c + 1 < count) out[m++] = c + 1;
  if (periodic && c == 0 && count > 2) out[m++] = count - 1;
  return m;
}

}  // namespace

void Neighbourhood::add(BeadRange range) {
  beads += range.end - range.begin;
  if (count > 0 && ranges[count - 1].end == range.begin) {
    ranges[count - 1].end = range.end;
  } else {
    ranges[count++] = range;
  }
}

void CellGrid::fit(const Settings& settings, const Extent& extent, std::int64_t beads) {
  double edge = 2 * extent.reach * (1 + 1e-9);
  for (;;) {
    double total = 1;
    for (int a = 0; a < 3; ++a) {
      const double period = settings.periodic.length[a];
      periodic_[a] = period > 0;
      low_[a] = periodic_[a] ? settings.periodic_low[a] : extent.low[a];
      const double length = periodic_[a] ? period : extent.high[a] - extent.low[a];
      cells_[a] = std::max(1, static_cast<int>(std::floor(length / edge)) + (periodic_[a] ? 0 : 1));
      if (cells_[a] <= 3) cells_[a] = 1;  // (nearly) all would be neighbours, in more pieces
      inverse_edge_[a] = periodic_[a] ? cells_[a] / length : 1.0 / edge;
      total *= cells_[a];
    }
    if (total <= 4.0 * static_cast<double>(beads) + 1000) break;
    edge *= 1.26;
  }
  choose_axes(settings);
}

/// Slowest along the longest axis that is not periodic (slabs), fastest along the next, so that rows of cells are long.
void CellGrid::choose_axes(const Settings& settings) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    if (periodic_[a] != periodic_[b]) return periodic_[b];
    return settings.high[a] - settings.low[a] > settings.high[b] - settings.low[b];
  });
  axis_[0] = order[0];
  axis_[2] = order[1];
  axis_[1] = order[2];
}

std::uint32_t CellGrid::cell_of(const PositionLine& bead) const {
  std::uint32_t cell = 0;
  for (const int a : axis_) {
    const int c = std::clamp(static_cast<int>((bead.centre[a] - low_[a]) * inverse_edge_[a]), 0, cells_[a] - 1);
    cell = cell * static_cast<std::uint32_t>(cells_[a]) + static_cast<std::uint32_t>(c);
  }
  return cell;
}

void CellGrid::number(std::vector<std::uint32_t>& cells_of_beads) {
  start_.assign(std::int64_t{cells_[0]} * cells_[1] * cells_[2] + 1, 0);
  for (const std::uint32_t cell : cells_of_beads) ++start_[cell + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::uint32_t& index : cells_of_beads) index = next[index]++;
}

std::int64_t CellGrid::cell_at(std::int64_t bead) const {
  return std::upper_bound(start_.begin(), start_.end(), static_cast<std::uint32_t>(bead)) - start_.begin() - 1;
}

Neighbourhood CellGrid::round(std::int64_t cell) const {
  const int n[3] = {cells_[axis_[0]], cells_[axis_[1]], cells_[axis_[2]]};
  const std::uint32_t number = static_cast<std::uint32_t>(cell), row = number / static_cast<std::uint32_t>(n[2]);
  const int own[3] = {static_cast<int>(row) / n[1], static_cast<int>(row) % n[1],
                      static_cast<int>(number % static_cast<std::uint32_t>(n[2]))};
  int near[3][3], m[3];
  for (int k = 0; k < 3; ++k) m[k] = around(own[k], n[k], periodic_[axis_[k]], near[k]);
  Neighbourhood found;
  for (int a = 0; a < m[0]; ++a) {
    for (int b = 0; b < m[1]; ++b) {
      const std::int64_t row = (std::int64_t{near[0][a]} * n[1] + near[1][b]) * n[2];
      for (int first = 0, last = 0; first < m[2]; first = ++last) {  // neighbours that follow one another in one go
        while (last + 1 < m[2] && near[2][last + 1] == near[2][last] + 1) ++last;
        const BeadRange range{start_[row + near[2][first]], start_[row + near[2][last] + 1]};
        if (range.begin < range.end && range.begin < end_of(cell)) found.add(range);
      }
    }
  }
  return found;
}

}  // namespace millscope::dem
