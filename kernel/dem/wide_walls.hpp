// The part of wide.cpp that is for walls; each of its builds has its own.
//
//   x, r       centre and radius of the bead;  n  normal, from the wall to the bead;  δ overlap
//   a          arm, from the bead's centre to the contact: r − δ/2
//   l          lever, from the body's centre to the contact: x − a n − c
//   v_w        velocity of the body there: V + Ω × l
#pragma once

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {
namespace {

inline void to_frame(const WallPose& pose, std::int64_t count, double* const (&position)[3]) {
  double* __restrict x = position[0];
  double* __restrict y = position[1];
  double* __restrict z = position[2];
  const WallPose p = pose;
  for (std::int64_t k = 0; k < count; ++k) {
    const double dx = x[k] - p.offset[0], dy = y[k] - p.offset[1], dz = z[k] - p.offset[2];
    x[k] = p.rotation[0][0] * dx + p.rotation[1][0] * dy + p.rotation[2][0] * dz;
    y[k] = p.rotation[0][1] * dx + p.rotation[1][1] * dy + p.rotation[2][1] * dz;
    z[k] = p.rotation[0][2] * dx + p.rotation[1][2] * dy + p.rotation[2][2] * dz;
  }
}

/// Lines of four beads from place k on: centre to `lever`, velocity to `velocity`, spin to `spin_i`.
inline void gather_four_at_wall(const WallGather& g, std::int64_t k, const WallBatch& b) {
  const FourBeads bead = four_beads(g.position, g.motion, [&](int c) { return b.bead[k + c]; });
  store_each(b.lever, k, bead.x);
  store_each(b.velocity, k, bead.v);
  store_each(b.spin_i, k, bead.w);
  store4_unaligned(b.radius + k, bead.x[3]);
  store4_unaligned(b.mass + k, four(1.0) / bead.v[3]);
}

/// Normals into the world's frame.
inline void turn_normals(const WallPose& p, std::int64_t count, const WallBatch& b) {
  double* __restrict nx = b.normal[0];
  double* __restrict ny = b.normal[1];
  double* __restrict nz = b.normal[2];
#pragma GCC ivdep
  for (std::int64_t k = 0; k < count; ++k) {
    const double x = nx[k], y = ny[k], z = nz[k];
    nx[k] = p.rotation[0][0] * x + p.rotation[0][1] * y + p.rotation[0][2] * z;
    ny[k] = p.rotation[1][0] * x + p.rotation[1][1] * y + p.rotation[1][2] * z;
    nz[k] = p.rotation[2][0] * x + p.rotation[2][1] * y + p.rotation[2][2] * z;
  }
}

/// Lever, velocity of the wall and of the surfaces against each other, one component after the other.
inline void wall_kinematics(const WallPose& p, std::int64_t count, const WallBatch& b) {
  const double* __restrict overlap = b.overlap;
  const double* __restrict radius = b.radius;
  double* __restrict arm = b.arm;
  for (std::int64_t k = 0; k < count; ++k) arm[k] = radius[k] - 0.5 * overlap[k];
  for (int a = 0; a < 3; ++a) {
    double* __restrict lever = b.lever[a];
    const double* __restrict normal = b.normal[a];
    for (std::int64_t k = 0; k < count; ++k) lever[k] = lever[k] - arm[k] * normal[k] - p.centre[a];
  }
  for (int a = 0; a < 3; ++a) {
    const int q = (a + 1) % 3, s = (a + 2) % 3;
    const double* __restrict lq = b.lever[q];
    const double* __restrict ls = b.lever[s];
    const double* __restrict wq = b.spin_i[q];
    const double* __restrict ws = b.spin_i[s];
    const double* __restrict nq = b.normal[q];
    const double* __restrict ns = b.normal[s];
    double* __restrict wall = b.wall_velocity[a];
    double* __restrict velocity = b.velocity[a];
    double* __restrict spin_j = b.spin_j[a];
    for (std::int64_t k = 0; k < count; ++k) {
      wall[k] = p.velocity[a] + (p.omega[q] * ls[k] - p.omega[s] * lq[k]);
      velocity[k] = velocity[k] - arm[k] * (wq[k] * ns[k] - ws[k] * nq[k]) - wall[k];
      spin_j[k] = p.omega[a];
    }
  }
}

/// The padding is a gap of 1 m at rest.
inline void pad_walls(std::int64_t count, std::int64_t padded, const WallBatch& b) {
  for (std::int64_t k = count; k < padded; ++k) {
    b.overlap[k] = -1.0;
    b.radius[k] = b.mass[k] = 1.0;
    for (int a = 0; a < 3; ++a) {
      b.normal[a][k] = a == 0 ? 1.0 : 0.0;
      b.velocity[a][k] = b.spin_i[a][k] = b.spin_j[a][k] = 0.0;
    }
  }
}

void gather_walls(const WallGather& g, const WallPose& pose, std::int64_t count, WallBatch& b) {
  const std::int64_t padded = padded_count(count);
  for (std::int64_t k = 0; k < padded; ++k) {
    const std::uint32_t contact = b.contact[k < count ? k : count - 1];
    b.bead[k] = b.bead[k < count ? k : count - 1];
    b.overlap[k] = g.overlap[contact];
    for (int a = 0; a < 3; ++a) b.normal[a][k] = g.normal[a][contact];
  }
  for (std::int64_t k = 0; k < padded; k += 4) gather_four_at_wall(g, k, b);
  turn_normals(pose, padded, b);
  wall_kinematics(pose, padded, b);
  pad_walls(count, padded, b);
  for (std::int64_t k = 0; k < padded; ++k) {
    b.radius_i[k] = b.radius[k];
    b.radius_j[k] = 0.0;
  }
}

/// Torque on the bead: a (F × n); on the body: −l × F; power of the body: F · v_w; with moments, those too.
inline void wall_torques(const WallPose& pose, std::int64_t count, bool with_moments, const WallBatch& b) {
  const WallPose p = pose;
  double* __restrict power = b.wall_power;
  for (std::int64_t k = 0; k < count; ++k) power[k] = 0.0;
  for (int a = 0; a < 3; ++a) {
    const int q = (a + 1) % 3, s = (a + 2) % 3;
    const double* __restrict fa = b.force[a];
    const double* __restrict fq = b.force[q];
    const double* __restrict fs = b.force[s];
    const double* __restrict nq = b.normal[q];
    const double* __restrict ns = b.normal[s];
    const double* __restrict lq = b.lever[q];
    const double* __restrict ls = b.lever[s];
    const double* __restrict arm = b.arm;
    const double* __restrict wall = b.wall_velocity[a];
    const double* __restrict mi = b.moment_i[a];
    const double* __restrict mj = b.moment_j[a];
    double* __restrict on_bead = b.torque[a];
    double* __restrict on_body = b.body_torque[a];
    for (std::int64_t k = 0; k < count; ++k) {
      on_bead[k] = arm[k] * (fq[k] * ns[k] - fs[k] * nq[k]);
      on_body[k] = -(lq[k] * fs[k] - ls[k] * fq[k]);
      power[k] += fa[k] * wall[k];
    }
    if (!with_moments) continue;
    for (std::int64_t k = 0; k < count; ++k) {
      on_bead[k] += mi[k];
      on_body[k] += mj[k];
      power[k] -= mj[k] * p.omega[a];
    }
  }
}

void scatter_walls(const WallPose& pose, const ForceWindow& force, std::int64_t count, bool with_moments, WallBatch& b, WallSums& sums) {
  wall_torques(pose, padded_count(count), with_moments, b);
  Four body_force = four(0.0), body_torque = four(0.0);
  double power = 0;
  for (std::int64_t k = 0; k < count; k += 4) {
    Four f[4], on_bead[4], on_body[4];
    lines_of(b.force, k, f);
    lines_of(b.torque, k, on_bead);
    lines_of(b.body_torque, k, on_body);
    const int lanes = count - k < 4 ? static_cast<int>(count - k) : 4;
    for (int c = 0; c < lanes; ++c) {
      ForceLine& line = force[b.bead[k + c]];
      store4(line.f, load4(line.f) + f[c]);
      store4(line.t, load4(line.t) + on_bead[c]);
      body_force -= f[c];
      body_torque += on_body[c];
      power += b.wall_power[k + c];
    }
  }
  store4_unaligned(sums.force, body_force);
  store4_unaligned(sums.torque, body_torque);
  sums.power = power;
}

}  // namespace
}  // namespace millscope::dem
