// What a system is told at its beginning.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/dem/lines.hpp"

namespace millscope::dem {

struct Settings {
  double time_step = 0;  ///< s
  int partitions = 1;    ///< K
  int threads = 1;
  PeriodicBox periodic{};
  double periodic_low[3] = {0, 0, 0};
  double skin_steps = 40;           ///< a bead's skin lasts this many steps at its present speed …
  double skin_base = 0.05;          ///< … beyond this fraction of its radius
  double skin_cap = 0.6;            ///< and no more than this fraction of the largest radius
  double low[3], high[3];           ///< a bead outside has left the domain, m
  std::int64_t wear_from_step = 0;  ///< what is worn before is not counted
  std::string instruction_set;      ///< "" for the best
};

/// K for a charge: a function of the case alone, never of the machine, for K decides the last bits of a result.
int partitions_for(std::int64_t beads);

/// A coordinate along `axis` brought into the periodic box; as it is where the axis is not periodic.
double wrapped(const Settings& settings, int axis, double coordinate);

/// UserError where a period is shorter than two interaction distances: a pair would then be near in two ways.
void check_periods(const Settings& settings, double largest_radius, double reach);

}  // namespace millscope::dem
