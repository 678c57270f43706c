// How beads go from one frame to the next: how far, and whether their velocities say the same.
#pragma once

#include <cstddef>
#include <vector>

#include "studies/frames/beads.hpp"
#include "studies/frames/mill_file.hpp"
#include "studies/frames/wall_watch.hpp"

namespace millscope::frames {

class MotionWatch {
 public:
  explicit MotionWatch(const MillFile& mill) : mill_(mill) {}

  /// The next frame; `radius`: of each bead. Where the files say no velocities and frames are near, `walls` receives the differences.
  void look(const Beads& beads, const std::vector<double>& radius, WallWatch& walls);
  /// After the last frame. Throws base::UserError where velocities, times and places contradict each other.
  void judge(bool numbered) const;
  /// The distance that 99 % of the beads go at most from one frame to the next, the median over the frames, m; 0: not known. Only without
  /// velocities.
  double stride() const;

 private:
  struct Step {
    std::size_t now = 0, before = 0;  ///< rows of one bead
    base::Vector3 way{};              ///< m
  };
  std::vector<Step> steps_to(const Beads& beads) const;
  void compare(const std::vector<Step>& steps, const Beads& beads, const std::vector<double>& radius);

  const MillFile& mill_;
  Beads before_;
  std::vector<double> strides_;
  std::vector<double> off_;   ///< |way − v Δt| / |v Δt| of a bead in a step
  std::vector<double> part_;  ///< |way| / |v Δt|
};

}  // namespace millscope::frames
