// Results that no analyzer has made, with blocks and resamples, so that the truth is known.
#pragma once

#include <cstdint>

#include "studies/analysis/results.hpp"

namespace compare_test {

struct MadeUp {
  std::uint64_t seed = 1;
  std::size_t blocks = 40;
  double omega = -6;    ///< rad/s
  double power = 0;     ///< added to the power, W; a block's deviation is 0.5 W
  double speed = 0;     ///< added to the speed in the cells of one region, m/s; a block's deviation is 0.1 m/s
  double critical = 8;  ///< a given quantity without uncertainty, rad/s
  std::size_t cells = 12;
};

/// power.power_gravity, power.centre_of_mass_x, distributions.x_percent and .x_cumulative, pept_grid.speed and .velocity_x on
/// cells × cells over a mill of 0.15 m radius, pept_grid.kind (names), models.critical_speed, power.seconds (bookkeeping).
millscope::analysis::ResultSet make_results(const MadeUp& recipe);

}  // namespace compare_test
