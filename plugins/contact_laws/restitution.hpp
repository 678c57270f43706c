// From the coefficient of restitution to the damping of the contact laws.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "millscope/pack.hpp"

namespace millscope::laws {

/// Smallest e that is told apart from zero; |β| is 0.975 there.
inline constexpr double kSmallestRestitution = 1e-6;

/// |β| = −ln e/√(ln² e + π²): damping as a fraction of the critical one that gives a linear spring the restitution e.
inline double damping_fraction(double restitution) {
  const double logarithm = std::log(std::clamp(restitution, kSmallestRestitution, 1.0));
  return -logarithm / std::sqrt(logarithm * logarithm + std::numbers::pi * std::numbers::pi);
}

/// For a linear spring: 2|β|, exact when tension is allowed.
inline double linear_damping(double restitution) { return 2.0 * damping_fraction(restitution); }

/// For laws with F ∝ δ^{3/2}: 2√(5/6)|β|, which gives the restitution e exactly (Antypov & Elliott 2011) when tension is allowed.
inline double hertz_damping(double restitution) { return 2.0 * std::sqrt(5.0 / 6.0) * damping_fraction(restitution); }

}  // namespace millscope::laws
