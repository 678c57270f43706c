// Vectors of three numbers where nothing is wide, and the way from there to the wide loops: walls.
#pragma once

#include "kernel/dem/lines.hpp"
#include "kernel/dem/motion.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {

using base::dot;

/// For the wide loops.
inline WallPose plain(const Pose& p) {
  WallPose w{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) w.rotation[a][b] = p.rotation[a][b];
    w.offset[a] = p.offset[a];
    w.centre[a] = p.centre[a];
    w.velocity[a] = p.velocity[a];
    w.omega[a] = p.omega[a];
  }
  return w;
}

}  // namespace millscope::dem
