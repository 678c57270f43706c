// Beads that begin where another run of the same mill ended: a charge that turns already, in place of one that is filled in and settled.
#pragma once

#include "kernel/base/hash.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::run {

/// Places, velocities and spins of the beads and the place of the walls, from the run that the case's `start` names; contact histories are
/// not taken over. Radii and densities are this case's. Beads too many are taken away by the seed, those that lack are put at free places,
/// at rest. Throws UserError where that run does not fit.
void take_over_beads(Assembly& a);

/// Of all geometries, without their motion.
base::Hash& add_surfaces(const Assembly& a, base::Hash& hash);
inline std::int64_t surfaces_of(const Assembly& a) {
  base::Hash hash;
  return static_cast<std::int64_t>(add_surfaces(a, hash).value());
}

}  // namespace millscope::run
