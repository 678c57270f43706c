// Textbook equations for tumbling mills, with the corrections that the printed ones need (Chagas 2015, Eq. 3.1–3.5 and 4.1).
//
//   D, L mill diameter and length, m; d bead diameter, m; M charge, kg; J filling on the bare shell's volume; φ porosity;
//   ρ true density of the beads, kg/m³; c speed over critical speed
#pragma once

#include <cmath>
#include <numbers>

namespace millscope::analyzers::models {

/// Eq. 3.1: N_c = 42.3/√(D − d) rpm; here in rad/s. Needs D > d.
inline double critical_speed(double diameter, double bead) { return 42.3 / std::sqrt(diameter - bead) * std::numbers::pi / 30; }

inline double volume(double diameter, double length) { return 0.25 * std::numbers::pi * diameter * diameter * length; }

/// Eq. 3.2: J = V_beads/(V_mill (1 − φ)).
inline double filling(double mass, double density, double mill_volume, double porosity) {
  return mass / density / (mill_volume * (1 - porosity));
}

/// Eq. 4.1: M = (1 − φ) J V ρ, kg.
inline double mass(double filling, double density, double mill_volume, double porosity) {
  return (1 - porosity) * filling * mill_volume * density;
}

/// Eq. 3.3 with the factor J that the print lacks, W:
/// P = 7.33 A J c (1 − 0.937 J) (1 − 0.1/2^(9 − 10 c)) ρ L D^2.3 kW, ρ in t/m³. A: 1 wet overflow, 1.16 wet grate, 1.08 dry grate.
inline double bond(double factor, double filling, double speed, double density, double diameter, double length) {
  return 1e3 * 7.33 * factor * filling * speed * (1 - 0.937 * filling) * (1 - 0.1 / std::exp2(9 - 10 * speed)) * (1e-3 * density) * length *
         std::pow(diameter, 2.3);
}

/// Eq. 3.4, W: P = 13.0 M √D (c − 0.1)/(1 + e^{15.7 (c − 0.94)}) (1 − 0.937 J)/(1 + 5.95 J⁵) kW, M in t.
inline double austin_concha(double mass, double diameter, double filling, double speed) {
  return 1e3 * 13.0 * (1e-3 * mass) * std::sqrt(diameter) * (speed - 0.1) / (1 + std::exp(15.7 * (speed - 0.94))) * (1 - 0.937 * filling) /
         (1 + 5.95 * std::pow(filling, 5));
}

inline constexpr double kOverflow = 7.98, kGrate = 9.10;  ///< Morrell's K

/// Speed over critical speed at which Morrell's power vanishes again.
inline double morrell_limit(double filling) { return 0.954 - 0.135 * filling; }
/// Morrell's filling of largest power.
inline double morrell_a(double speed) { return 5.97 * speed - 4.43 * speed * speed - 0.985; }

/// Eq. 3.5 with Morrell's own constants, net power, W:
/// P = K D^2.5 L ρ_bulk J c (a − J)/a² [1 − (1 − 0.954 + 0.135 J) e^{−19.42 (0.954 − 0.135 J − c)}] kW, ρ_bulk in t/m³ (dry: ρ (1 − φ)).
inline double morrell(double constant, double diameter, double length, double bulk_density, double filling, double speed) {
  const double a = morrell_a(speed), limit = morrell_limit(filling);
  return 1e3 * constant * std::pow(diameter, 2.5) * length * (1e-3 * bulk_density) * filling * speed * (a - filling) / (a * a) *
         (1 - (1 - limit) * std::exp(-19.42 * (limit - speed)));
}

}  // namespace millscope::analyzers::models
