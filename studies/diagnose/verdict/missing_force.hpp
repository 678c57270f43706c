// The missing mean acceleration without a form: what the recorded beads feel by place and speed that the simulated ones do not.
//
//   Δa(cell) = a(recording) − a(simulation through the same camera),  a = Σ Δv/Σ Δt (analyzer mean_acceleration)
#pragma once

#include <vector>

#include "studies/diagnose/verdict/held_out.hpp"

namespace millscope::diagnose {

struct ForceCell {
  double r_low = 0, r_high = 0;          ///< m
  double angle_low = 0, angle_high = 0;  ///< deg from 6 o'clock in the turning sense
  double place[2] = {0, 0};              ///< m, middle in the recording's frame, from the axis
  double velocity[2] = {0, 0};           ///< m/s, of the recorded beads
  base::Interval90 x, y;                 ///< m/s²
  double p = 1;                          ///< that chance makes it as large, for all cells of the condition together (Bonferroni)
};

struct ForceBySpeed {
  double low = 0, high = 0;  ///< speed over the shell's
  base::Interval90 along;    ///< m/s² along the motion
};

struct MissingForce {
  std::size_t condition = 0;
  double omega = 0;              ///< rad/s of the shell in the recording's frame
  std::vector<ForceCell> cells;  ///< those that both sides visited, the surest first
  std::vector<ForceBySpeed> by_speed;
};

/// Of the retuned base in the fitted conditions, two seeds each. Empty where the machinery cannot look again.
std::vector<MissingForce> missing_force(const HeldOutRequest& request);

/// "speed75, 120 to 150 mm, 30 to 60° past 6 o'clock: …".
std::string force_sentence(const Question& question, std::size_t condition, const ForceCell& cell);

}  // namespace millscope::diagnose
