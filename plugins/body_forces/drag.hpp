// Drag of a fluid on a single sphere, which the body forces share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::body_forces {

struct Fluid {
  double density;    ///< ρ, kg/m³
  double viscosity;  ///< η, Pa s
};

/// F/|u| of a sphere of diameter d at the speed |u| through the fluid, N s/m: Schiller & Naumann 1933, Newton's C_d = 0.44 above Re = 800.
///
///   F = 3 π η d (1 + 0.15 Re^0.687) u,  Re = ρ |u| d/η
inline double drag_rate(const Fluid& fluid, double diameter, double speed) {
  const double momentum = fluid.density * speed * diameter;  // η Re
  const double reynolds = fluid.viscosity > 0.0 ? momentum / fluid.viscosity : 0.0;
  const double schiller = 3.0 * std::numbers::pi * diameter * fluid.viscosity * (1.0 + 0.15 * std::pow(reynolds, 0.687));
  const double newton = 0.44 * std::numbers::pi / 8.0 * diameter * momentum;
  return reynolds > 800.0 || fluid.viscosity == 0.0 ? std::max(schiller, newton) : schiller;
}

}  // namespace millscope::body_forces
