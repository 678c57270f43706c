// Motions of a charge that are known: Davis's cascade of circle arcs and parabolas, a vortex, flights with drag, random walks.
#pragma once

#include <algorithm>
#include <cmath>

#include "analyzers_fields/analyzer.hpp"
#include "millscope/observation_adapter.hpp"

namespace analyzers_test {

inline constexpr double kRadians = kPi / 180;

/// Davis 1919: a bead at radius r rides with the shell until gravity's radial part equals the centrifugal, Ω² r = g cos α with α from
/// 12 o'clock, then flies and comes back to the circle. Turns counter-clockwise, charge rising at x > 0.
struct Davis {
  double omega, gravity = 9.81;

  double departure(double r) const { return kPi - std::acos(std::min(1.0, omega * omega * r / gravity)); }  ///< rad from 6 o'clock
  Sample flight(double r, double t) const {
    const double a = departure(r), v = omega * r;
    const double u = v * std::cos(a), w = v * std::sin(a);
    return {{r * std::sin(a) + u * t, -r * std::cos(a) + w * t - 0.5 * gravity * t * t, 0}, {u, w - gravity * t, 0}};
  }
  double flight_time(double r) const {  ///< until the parabola meets the circle again
    double low = 0.02, high = 0.02;
    const auto inside = [&](double t) { return std::hypot(flight(r, t).position[0], flight(r, t).position[1]) < r; };
    while (inside(high)) high += 0.01;
    for (int i = 0; i < 60; ++i) (inside(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return high;
  }
  double landing(double r) const {  ///< rad from 6 o'clock
    const Sample s = flight(r, flight_time(r));
    return std::atan2(s.position[0], -s.position[1]);
  }
  double period(double r) const { return flight_time(r) + (departure(r) - landing(r)) / omega; }
  /// A bead that lands at time 0.
  Sample at(double r, double t) const {
    const double ride = (departure(r) - landing(r)) / omega;
    t = std::fmod(t, ride + flight_time(r));
    if (t >= ride) return flight(r, t - ride);
    const double a = landing(r) + omega * t;
    return {{r * std::sin(a), -r * std::cos(a), 0}, {omega * r * std::cos(a), omega * r * std::sin(a), 0}};
  }
};

/// Beads spread evenly over the ring from `inner` to `outer`, each with a phase of its own.
inline Motion davis_charge(const Davis& davis, std::int64_t beads, double inner, double outer) {
  std::vector<double> radius, phase;
  for (std::int64_t id = 0; id < beads; ++id) {
    const double share = (static_cast<double>(id) + 0.5) / static_cast<double>(beads);
    radius.push_back(std::sqrt(inner * inner + share * (outer * outer - inner * inner)));
    phase.push_back(davis.period(radius.back()) * std::fmod(0.6180339887 * static_cast<double>(id), 1.0));
  }
  return [=](std::int64_t id, double t) {
    const auto i = static_cast<std::size_t>(id);
    return davis.at(radius[i], t + phase[i]);
  };
}

/// A vortex: beads on ellipses about (x, y) with half axes a·size and b·size, turning counter-clockwise at `rate`.
struct Vortex {
  double x, y, a, b, rate;
};
inline Motion vortex_charge(const Vortex& vortex, std::int64_t beads) {
  return [=](std::int64_t id, double t) {
    const double size = std::sqrt((static_cast<double>(id) + 0.5) / static_cast<double>(beads));
    const double angle = 2.399963229728653 * static_cast<double>(id) + vortex.rate * t;
    const double c = std::cos(angle), s = std::sin(angle);
    return Sample{{vortex.x + vortex.a * size * c, vortex.y + vortex.b * size * s, 0},
                  {-vortex.rate * vortex.a * size * s, vortex.rate * vortex.b * size * c, 0}};
  };
}

/// Ornstein–Uhlenbeck process of unit variance and correlation time tau, sampled with a step.
inline std::vector<double> noise_with_memory(Random& random, std::size_t n, double step, double tau) {
  const double keep = std::exp(-step / tau), kick = std::sqrt(1 - keep * keep);
  std::vector<double> all(n);
  double value = random.normal();
  for (double& x : all) {
    x = value;
    value = keep * value + kick * random.normal();
  }
  return all;
}

inline std::vector<double> even_weights(std::size_t n, double step) { return std::vector<double>(n, step); }

}  // namespace analyzers_test
