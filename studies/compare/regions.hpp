// Regions of a map across the mill: rings by sectors, counted as an engineer reads a clock.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/picture/picture.hpp"

namespace millscope::studies {

/// Where the mill of a map stands.
struct MillPlace {
  double radius = 0;  ///< m; 0: unknown
  double sense = 0;   ///< sign of Ω; 0: unknown
};

struct Region {
  std::string name;                ///< "0.8–1 R, 45–90° past 6 o'clock"
  std::vector<std::size_t> cells;  ///< [ny, nx] indices
  std::size_t ring = 0;
  int sector = 0;
};

/// Three rings (to 0.5, 0.8 and 1 R) by eight sectors of 45°, from 6 o'clock in the turning sense; those without cells are left out. None
/// where radius or sense are unknown.
std::vector<Region> regions_of(const CellAxis& y, const CellAxis& x, const MillPlace& mill);

/// The border between the regions that are chosen and the others, m; `chosen`: one flag for each region.
std::vector<Outline> borders_of(const std::vector<Region>& regions, const std::vector<bool>& chosen, const MillPlace& mill);

/// "x −85 mm, y −62 mm (0.70 R, 54° past 6 o'clock)"; the part in brackets only where the mill is known.
std::string place_text(double x, double y, const MillPlace& mill);

}  // namespace millscope::studies
