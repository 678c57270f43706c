// Rounds of the tracer: up with the shell, down over the charge or through the air.
#pragma once

#include <cstddef>
#include <vector>

#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

/// A turning point of the height y.
struct Extreme {
  std::size_t run = 0;
  std::size_t point = 0;
  bool top = false;
  bool continues = false;  ///< no long pause between the extreme before it and this one
};

/// A rise or fall counts when it is at least `height`, m; a pause longer than `longest_pause`, s, begins anew.
std::vector<Extreme> find_extremes(const recording::Recording& recording, double height, double longest_pause);

struct Circulations {
  std::size_t count = 0;     ///< whole ones: a rise and the fall after it, unbroken
  double least_height = 0;   ///< m: smaller loops are not counted
  double longest_pause = 0;  ///< s
  Finding time;              ///< mean time of one, s
  Finding per_turn;          ///< circulations per turn of the mill
  std::vector<Extreme> extremes;
};

/// `noise`: of y, m. `angular_velocity`: of the shell, rad/s; 0: unknown.
Circulations count_circulations(const recording::Recording& recording, double noise, double angular_velocity);

}  // namespace millscope::inspect
