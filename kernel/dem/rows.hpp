// Vectors of three numbers where nothing is wide: walls.
#pragma once

#include "kernel/dem/lines.hpp"
#include "kernel/dem/motion.hpp"

namespace millscope::dem {

using base::cross;
using base::dot;

inline Vector3 to_body(const Pose& p, const Vector3& x) {
  const Vector3 d{x[0] - p.offset[0], x[1] - p.offset[1], x[2] - p.offset[2]};
  Vector3 r{};
  for (std::size_t a = 0; a < 3; ++a) r[a] = p.rotation[0][a] * d[0] + p.rotation[1][a] * d[1] + p.rotation[2][a] * d[2];
  return r;
}

inline Vector3 to_world(const Pose& p, const Vector3& n) {
  Vector3 r{};
  for (std::size_t a = 0; a < 3; ++a) r[a] = p.rotation[a][0] * n[0] + p.rotation[a][1] * n[1] + p.rotation[a][2] * n[2];
  return r;
}

/// Centre of a bead. Periodic coordinates are wrapped at list rebuilds only: wrapped here, a bead that crosses the boundary would jump away
/// from the features that were listed for it. A surface must therefore reach a skin beyond the box (mesh: `period`).
inline Vector3 centre(const PositionLine& x) { return {x.centre[0], x.centre[1], x.centre[2]}; }

}  // namespace millscope::dem
