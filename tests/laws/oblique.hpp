// A sphere that hits a wall obliquely, and what is left of its motion.
#pragma once

#include "laws/two_bodies.hpp"

namespace laws_test {

inline constexpr double kPi = 3.14159265358979323846, kDegree = kPi / 180.0;

/// The centre's speed along the wall and away from it, m/s, and the spin, rad/s.
struct Rebound {
  double tangential, normal, spin;
  double surface(double radius) const { return tangential - radius * spin; }  ///< speed of the contact point along the wall
};

inline PairContext wall_pair(double young, double poisson, double radius, double density) {
  PairContext pair = bead_pair(radius, young, poisson, density);
  pair.smallest_radius = pair.largest_radius = radius;
  pair.smallest_mass = pair.largest_mass = bead(radius, density).mass;
  pair.with_wall = 1;
  return pair;
}

/// A sphere hits a wall (normal +x) at this angle from the normal, without spin.
inline Rebound hit(const Law& law, const Body& sphere, double speed, double angle, double time_step, double gap) {
  Body a = sphere;
  a.position = {a.radius + gap, 0, 0};
  a.velocity = {-speed * std::cos(angle), speed * std::sin(angle), 0};
  Collision c(law, a, fixed_wall());
  c.run(time_step);
  return {c.i().half_velocity[1], c.i().half_velocity[0], c.i().half_spin[2]};
}

/// The mean over where in a step the first touch falls.
inline Rebound mean_hit(const Law& law, const Body& sphere, double speed, double angle, double time_step) {
  constexpr int kStarts = 16;
  Rebound mean{};
  for (int k = 0; k < kStarts; ++k) {
    const Rebound r = hit(law, sphere, speed, angle, time_step, speed * std::cos(angle) * time_step * (k + 0.5) / kStarts);
    mean.tangential += r.tangential / kStarts;
    mean.normal += r.normal / kStarts;
    mean.spin += r.spin / kStarts;
  }
  return mean;
}

}  // namespace laws_test
