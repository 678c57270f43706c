#include "kernel/dem/settings.hpp"

#include <cmath>
#include <cstdio>

#include "kernel/base/error.hpp"

namespace millscope::dem {

int partitions_for(std::int64_t beads) {
  // A slab of fewer than a thousand beads does not fill its batches. A power of two, so that 2, 4, 8 … threads have equal shares. Each slab
  // keeps the work of every triangle: no more than 64.
  constexpr std::int64_t kFewest = 1000;
  int k = 1;
  while (2 * k * kFewest <= beads && k < 64) k *= 2;
  return k;
}

double wrapped(const Settings& settings, int axis, double coordinate) {
  const double length = settings.periodic.length[axis];
  return length > 0 ? coordinate - length * std::floor((coordinate - settings.periodic_low[axis]) / length) : coordinate;
}

void check_periods(const Settings& settings, double largest_radius, double reach) {
  for (int a = 0; a < 3; ++a) {
    const double needed = 4 * (largest_radius * (1 + settings.skin_cap) + 0.5 * reach), length = settings.periodic.length[a];
    if (length > 0 && length < needed) {
      char line[200];
      std::snprintf(line, sizeof line,
                    "the periodic length along %c is %.4g m; beads of this size need at least %.4g m: lengthen the slice", "xyz"[a], length,
                    needed);
      throw base::UserError(line);
    }
  }
}

}  // namespace millscope::dem
