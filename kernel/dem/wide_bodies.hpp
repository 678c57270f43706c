// The part of wide.cpp that hands beads to body forces and gives the beads what these answer; each of its builds has its own.
#pragma once

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {
namespace {

void gather_bodies(const PositionLine* position, const MotionLine* motion, BeadRange beads, const BodyForceArrays& arrays) {
  const BodyForceArrays b = arrays;
  const Four none[3] = {};
  for (std::int64_t k = 0; k < beads.end - beads.begin; k += 4) {
    const FourBeads bead = four_beads(position, motion, [&](int c) {
      const std::int64_t next = beads.begin + k + c;
      return next < beads.end ? next : beads.end - 1;  // the arrays have room for padding
    });
    store_each(b.position, k, bead.x);
    store_each(b.velocity, k, bead.v);
    store_each(b.spin, k, bead.w);
    store_each(b.force, k, none);
    store_each(b.moment, k, none);
    store4_unaligned(b.radius + k, bead.x[3]);
    store4_unaligned(b.mass + k, four(1.0) / bead.v[3]);
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
    Four f[4], t[4];
    lines_of(b.force, k, f);
    lines_of(b.moment, k, t);
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
