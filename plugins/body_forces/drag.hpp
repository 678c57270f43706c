// Drag of a fluid on a single sphere, which the body forces share.
#pragma once

#include <algorithm>
#include <cmath>

namespace millscope::body_forces {

inline constexpr double kPi = 3.14159265358979323846;

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
  const double schiller = 3.0 * kPi * diameter * fluid.viscosity * (1.0 + 0.15 * std::pow(reynolds, 0.687));
  const double newton = 0.44 * kPi / 8.0 * diameter * momentum;
  return reynolds > 800.0 || fluid.viscosity == 0.0 ? std::max(schiller, newton) : schiller;
}

}  // namespace millscope::body_forces
