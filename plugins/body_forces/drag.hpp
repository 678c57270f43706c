// Drag of a fluid on a single sphere, which the body forces share.
#pragma once

#include <numbers>

#include "millscope/functions.hpp"

namespace millscope::body_forces {

struct Fluid {
  double density;    ///< ρ, kg/m³
  double viscosity;  ///< η, Pa s
};

/// F/|u| of a sphere of diameter d at the speed |u| through the fluid, N s/m: Schiller & Naumann 1933, Newton's C_d = 0.44 above Re = 800.
///
///   F = 3 π η d (1 + 0.15 Re^0.687) u,  Re = ρ |u| d/η
template <class R>
R drag_rate(const Fluid& fluid, const R& diameter, const R& speed) {
  const R momentum = R(fluid.density) * speed * diameter;  // η Re
  const R newton = R(0.44 * std::numbers::pi / 8.0) * diameter * momentum;
  if (fluid.viscosity == 0.0) return newton;
  const R reynolds = momentum / R(fluid.viscosity);
  const R schiller = R(3.0 * std::numbers::pi * fluid.viscosity) * diameter * (R(1.0) + R(0.15) * power(reynolds, 0.687));
  return select(reynolds > R(800.0), maximum(schiller, newton), schiller);
}

}  // namespace millscope::body_forces
