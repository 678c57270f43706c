// Places in a cross-section of the mill, and its regions: rings by sectors, counted as an engineer reads a clock.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace millscope::base {

/// What places are counted from: the axis is at x = y = 0.
struct MillPlace {
  double radius = 0;  ///< m; 0: unknown
  double sense = 0;   ///< sign of Ω; 0: unknown

  bool known() const { return radius > 0 && sense != 0; }
};

/// `omega`: rad/s.
MillPlace mill_place(double radius, double omega);

struct Region {
  std::string name;                ///< "0.8–1 R, 45–90° past 6 o'clock"
  std::vector<std::size_t> cells;  ///< [ny, nx] indices
  std::size_t ring = 0;
  int sector = 0;
};

/// `y_edges`, `x_edges`: of the map's cells, m. Three rings (to 0.5, 0.8 and 1 R) by eight sectors of 45°, from 6 o'clock in the turning
/// sense; those without cells are left out. None where radius or sense are unknown.
std::vector<Region> regions_of(std::span<const double> y_edges, std::span<const double> x_edges, const MillPlace& mill);

/// The border between the regions that are chosen and the others, as lines of x and y, m; `chosen`: one flag for each region.
std::vector<std::vector<std::array<double, 2>>> borders_of(const std::vector<Region>& regions, const std::vector<bool>& chosen,
                                                           const MillPlace& mill);

/// "0.70 R, 54° past 6 o'clock"; "" where the mill is not known. x, y: m.
std::string place_in_mill(double x, double y, const MillPlace& mill);

}  // namespace millscope::base
