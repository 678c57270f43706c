// Two spheres, or a sphere and a fixed wall, in free collision through a law's table: the kernel's time stepping for one contact.
//
// Leapfrog: velocities at half steps; the law is given velocities predicted at the time of the positions.
#pragma once

#include <cmath>

#include "laws/plugins.hpp"

namespace laws_test {

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector plus(const Vector& a, double s, const Vector& b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }

struct Body {
  double radius, mass;
  Vector position{}, velocity{}, spin{};
  Vector half_velocity{}, half_spin{}, last_force{}, last_moment{};
  bool wall = false;
  double inertia() const { return 0.4 * mass * radius * radius; }
  double kinetic() const {
    return wall ? 0.0 : 0.5 * mass * dot(half_velocity, half_velocity) + 0.5 * inertia() * dot(half_spin, half_spin);
  }
};

struct Outcome {
  double contact_time = 0, largest_overlap = 0, lowest_force = 0;
  std::array<double, kMaxChannels> lost{};
  double kinetic_before = 0, kinetic_after = 0;
  double total_lost() const {
    double sum = 0;
    for (double x : lost) sum += x;
    return sum;
  }
};

class Collision {
 public:
  Collision(const Law& law, Body i, Body j) : i_(i), j_(j), law_(&law), contacts_(1) {
    contacts_.own_friction = true;
    const bool wall = j.wall;
    contacts_.radius[0] = wall ? i.radius : i.radius * j.radius / (i.radius + j.radius);
    contacts_.mass[0] = wall ? i.mass : i.mass * j.mass / (i.mass + j.mass);
    for (Body* b : {&i_, &j_}) b->half_velocity = b->velocity, b->half_spin = b->spin;
  }

  /// From just before touch until the bodies have parted for good.
  Outcome run(double dt, double longest = 1.0) {
    Outcome out;
    out.kinetic_before = i_.kinetic() + j_.kinetic();
    const double reach = law_->table().reach(law_->get(), contacts_.radius[0]);
    bool touched = false;
    for (double t = 0; t < longest; t += dt) {
      const double overlap = measure();
      if (overlap >= -reach) {
        contacts_.step(*law_, dt);
        act(dt);
        if (overlap > 0.0) touched = true, out.contact_time += dt;
        for (std::size_t k = 0; k < kMaxChannels; ++k) out.lost[k] += contacts_.power[k][0] * dt;
        out.largest_overlap = std::max(out.largest_overlap, overlap);
        out.lowest_force = std::min(out.lowest_force, contacts_.normal_force[0]);
      } else {
        act(dt, false);
        if (touched) break;
      }
    }
    out.kinetic_after = i_.kinetic() + j_.kinetic();
    return out;
  }

  const Body& i() const { return i_; }
  const Body& j() const { return j_; }

 private:
  double measure() {
    Vector apart = plus(i_.position, -1.0, j_.position);
    const double distance = j_.wall ? apart[0] : std::sqrt(dot(apart, apart));
    normal_ = j_.wall ? Vector{1, 0, 0} : Vector{apart[0] / distance, apart[1] / distance, apart[2] / distance};
    const double overlap = (j_.wall ? i_.radius : i_.radius + j_.radius) - distance;
    arm_i_ = i_.radius - (j_.wall ? overlap : 0.5 * overlap);
    arm_j_ = j_.radius - 0.5 * overlap;
    Vector v = plus(i_.velocity, -1.0, j_.velocity);
    v = plus(v, -arm_i_, cross(i_.spin, normal_));
    if (!j_.wall) v = plus(v, -arm_j_, cross(j_.spin, normal_));
    contacts_.overlap[0] = overlap;
    Contacts::put(contacts_.normal, 0, normal_);
    Contacts::put(contacts_.velocity, 0, v);
    return overlap;
  }

  void act(double dt, bool touching = true) {
    const Vector force = touching ? Contacts::at(contacts_.force, 0) : Vector{};
    advance(i_, force, plus({}, -arm_i_, cross(normal_, force)), dt);
    if (!j_.wall) advance(j_, plus({}, -1.0, force), plus({}, -arm_j_, cross(normal_, force)), dt);
  }

  static void advance(Body& b, const Vector& force, const Vector& moment, double dt) {
    b.half_velocity = plus(b.half_velocity, dt / b.mass, force);
    b.half_spin = plus(b.half_spin, dt / b.inertia(), moment);
    b.position = plus(b.position, dt, b.half_velocity);
    // The kernel's prediction: v(n+1) = v(n+½) + ½ Δt (2 a(n) − a(n−1)).
    b.velocity = plus(plus(b.half_velocity, dt / b.mass, force), -0.5 * dt / b.mass, b.last_force);
    b.spin = plus(plus(b.half_spin, dt / b.inertia(), moment), -0.5 * dt / b.inertia(), b.last_moment);
    b.last_force = force;
    b.last_moment = moment;
  }

  Body i_, j_;
  const Law* law_;
  Contacts contacts_;
  Vector normal_{};
  double arm_i_ = 0, arm_j_ = 0;
};

/// A glass sphere.
inline Body bead(double radius = 5e-3, double density = 2500.0) {
  Body b;
  b.radius = radius;
  b.mass = density * 4.18879020478639098 * radius * radius * radius;
  return b;
}

inline Body fixed_wall() {
  Body b;
  b.radius = b.mass = 1.0;
  b.wall = true;
  return b;
}

/// 20 % of the Rayleigh time of a softened glass bead: the time step of the reference case.
inline double rayleigh_step(double radius = 5e-3) {
  return 0.2 * 3.14159265358979 * radius * std::sqrt(2500.0 / 26e6) / (0.1631 * 0.23 + 0.8766);
}

/// Two equal beads that meet along x with this closing speed and this sideways speed of the first.
inline Collision head_on(const Law& law, double speed, double sideways = 0.0, double offset = 0.3) {
  Body a = bead(), b = bead();
  a.position = {a.radius + b.radius + offset * 1e-5, 0, 0};
  a.velocity = {-0.5 * speed, 0.5 * sideways, 0};
  b.velocity = {0.5 * speed, -0.5 * sideways, 0};
  return Collision(law, a, b);
}

}  // namespace laws_test
