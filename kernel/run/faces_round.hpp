// What the axis of a mill sees of its wall: in each direction the nearest place.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "millscope/geometry.hpp"

namespace millscope::run {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< rad

struct Facing {
  double distance;         ///< from the axis, m; infinity: no wall there
  std::uint64_t triangle;  ///< that is seen
};

/// In the plane at `z`, m, for directions 2π k/`directions` from the x axis. The axis is parallel to z.
std::vector<Facing> faces_round(const Surface& surface, const Interior& in, double z, int directions);

}  // namespace millscope::run
