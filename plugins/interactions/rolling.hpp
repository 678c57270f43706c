// What the rolling frictions share: the rolling part of a spin and the lever of the resisting moment.
#pragma once

#include "millscope/interaction_adapter.hpp"

namespace millscope::interactions {

/// The part of a spin that rolls: without the twist about the normal.
template <class R>
Vec<R> rolling_part(const Vec<R>& spin, const Vec<R>& normal) {
  return spin - dot(spin, normal) * normal;
}

/// Lever of μ_r: R*, or the bead's radius (the mean of two beads' radii, so that both feel the same moment).
template <class R>
R rolling_lever(const PairState<R>& pair, bool effective) {
  const R mean = select(pair.radius_j > R(0.0), R(0.5) * (pair.radius_i + pair.radius_j), pair.radius_i);
  return effective ? pair.radius : mean;
}

inline constexpr Parameter rolling_friction_parameter = pair_parameter(
    "rolling_friction", "1", kRequired, 0.0, 10.0, "Coefficient of rolling friction mu_r: resisting moment over (length x F_n).");
inline constexpr Parameter rolling_length_parameter =
    choice_parameter("length", "effective|radius", "effective",
                     "Lever of mu_r: R* or the bead's own radius; for equal beads mu_r changes twofold between them.");

}  // namespace millscope::interactions
