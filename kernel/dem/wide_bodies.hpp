// The part of wide.cpp that hands beads to body forces and gives the beads what these answer; each of its builds has its own.
#pragma once

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {
namespace {

void gather_bodies(const PositionLine* position, const MotionLine* motion, BeadRange beads, const BodyForceArrays& arrays) {
  const BodyForceArrays b = arrays;
  for (std::int64_t k = 0; k < beads.end - beads.begin; k += 4) {
    Four x[4], v[4], w[4];
    for (int c = 0; c < 4; ++c) {
      const std::int64_t next = beads.begin + k + c, i = next < beads.end ? next : beads.end - 1;  // the arrays have room for padding
      x[c] = load4(position + i);
      v[c] = load4(motion[i].v);
      w[c] = load4(motion[i].w);
    }
    transpose(x[0], x[1], x[2], x[3]);
    transpose(v[0], v[1], v[2], v[3]);
    transpose(w[0], w[1], w[2], w[3]);
    for (int a = 0; a < 3; ++a) {
      store4_unaligned(b.position[a] + k, x[a]);
      store4_unaligned(b.velocity[a] + k, v[a]);
      store4_unaligned(b.spin[a] + k, w[a]);
      store4_unaligned(b.force[a] + k, four(0.0));
      store4_unaligned(b.moment[a] + k, four(0.0));
    }
    store4_unaligned(b.radius + k, x[3]);
    store4_unaligned(b.mass + k, four(1.0) / v[3]);
    store4_unaligned(b.added_mass + k, four(0.0));
  }
}

/// The fluid that moves with a bead slows all that acts on it: (m + m_a) a = ΣF + m g, scaled so that the integrator's F/m + g gives that.
inline Four slowed(Four force, Four g, double mass, double added_mass) {
  const Four weight = four(mass) * g, ratio = four(mass / (mass + added_mass));
  return ratio * (force + weight) - weight;
}

void scatter_bodies(const ForceWindow& window, BeadRange beads, const double* acceleration, const BodyForceArrays& arrays) {
  const BodyForceArrays b = arrays;
  const ForceWindow lines = window;
  const Four g = {acceleration[0], acceleration[1], acceleration[2], 0.0};
  const std::int64_t count = beads.end - beads.begin;
  for (std::int64_t k = 0; k < count; k += 4) {
    Four f[4] = {load4(b.force[0] + k), load4(b.force[1] + k), load4(b.force[2] + k), four(0.0)};
    Four t[4] = {load4(b.moment[0] + k), load4(b.moment[1] + k), load4(b.moment[2] + k), four(0.0)};
    transpose(f[0], f[1], f[2], f[3]);
    transpose(t[0], t[1], t[2], t[3]);
    const int lanes = count - k < 4 ? static_cast<int>(count - k) : 4;
    for (int c = 0; c < lanes; ++c) {
      ForceLine& line = lines[beads.begin + k + c];
      const double added = b.added_mass[k + c];
      const Four force = load4(line.f) + f[c];
      store4(line.f, added == 0.0 ? force : slowed(force, g, b.mass[k + c], added));
      store4(line.t, load4(line.t) + t[c]);
    }
  }
}

}  // namespace
}  // namespace millscope::dem
