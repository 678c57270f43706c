// All beads, in the cell order of the last list rebuild; `id` is permanent.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/dem/aligned.hpp"
#include "kernel/dem/lines.hpp"

namespace millscope::dem {

struct Particles {
  AlignedVector<PositionLine> position;
  AlignedVector<MotionLine> motion;  ///< predicted, at the time of `position`
  AlignedVector<MotionLine> half;    ///< half a step earlier; lanes 3 and 7 as in `motion`
  AlignedVector<ForceLine> force;
  AlignedVector<AccelerationLine> acceleration;  ///< of the last step
  AlignedVector<ReferenceLine> reference;
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> material;

  std::int64_t count() const { return static_cast<std::int64_t>(position.size()); }
  void resize(std::size_t n) {
    position.resize(n);
    motion.resize(n);
    half.resize(n);
    force.resize(n);
    acceleration.resize(n);
    reference.resize(n);
    id.resize(n);
    material.resize(n);
  }
};

/// What is wrong with a bead, where it is, and why that may be.
std::string complaint(const Particles& particles, std::int64_t bead, double time, const char* what);

}  // namespace millscope::dem
