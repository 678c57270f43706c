// The state of a bead in cache-line records, and plain views that the wide code works on.
//
// Time levels (velocity Verlet in its leapfrog form, second order also for forces that depend on velocity):
//   x, predicted v and ω: step n;  half v and ω: step n − ½;  acceleration: step n − 1.
// The prediction is v(n−½) + ½ Δt (2 a(n−1) − a(n−2)). With a(n−1) alone it would lag by half a step's change of force, which always
// has the sign that makes damping look larger than it is: 2 % of the ledger at 14 steps per contact.
#pragma once

#include <cstdint>

namespace millscope::dem {

/// 32 bytes: centre (m) and radius (m).
struct alignas(32) PositionLine {
  double x, y, z, radius;
};

/// 64 bytes: velocity (m/s), 1/m (1/kg), spin (rad/s), 1/I (1/(kg m²)).
struct alignas(64) MotionLine {
  double v[3], inverse_mass, w[3], inverse_inertia;
};

/// 64 bytes: force (N) and torque (N m); the fourth lanes are unused.
struct alignas(64) ForceLine {
  double f[3], unused_f, t[3], unused_t;
};

/// 32 bytes: linear (m/s²) and angular (rad/s²) acceleration of the last step. It only enters the prediction, in the second order of
/// the step: single precision is ample.
struct alignas(32) AccelerationLine {
  float linear[4], angular[4];
};

/// 16 bytes: centre at the last list rebuild (m) and the square of the displacement that is allowed from there (m²).
struct alignas(16) ReferenceLine {
  float x, y, z, allowed2;
};

/// Where the forces of a slab's beads stand while its step is made: all of them side by side (mask −1), or, where beads are finished behind
/// the pair loop, in a ring that is just long enough and stays in the cache. Lines are zero before the first force and after the last.
struct ForceWindow {
  ForceLine* lines;
  std::int64_t mask;  ///< −1, or a power of two less one
  ForceLine& operator[](std::int64_t bead) const { return lines[bead & mask]; }
};

/// Periodic lengths per axis (m); 0: not periodic.
struct PeriodicBox {
  double length[3];
};

/// Numbers that law, interactions and pair parameters may keep per contact, all together.
inline constexpr int kMaxHistories = 24;

/// One part of the pair list: all listed pairs of one slab and one pair of materials. Owner i < partner j. Histories stand in the order of
/// the slots, for the touching ones only: a sweep reads those of the last step and writes those of this one.
struct PairListView {
  std::int64_t count;
  const std::uint32_t* owner;
  const std::uint32_t* partner;
  std::uint8_t* touching;                ///< 1 while within reach
  std::int64_t read, written;            ///< histories that the sweep has passed, and made
  const double* history[kMaxHistories];  ///< per contact of the last step
  double* next[kMaxHistories];           ///< per contact of this step: room for all that `written` plus one batch needs
  std::int32_t history_count;
};

/// Scratch of one worker for one batch: structure of arrays, each `kBatch + 8` doubles long, 64-byte aligned.
inline constexpr std::int64_t kBatch = 512;
inline constexpr std::int64_t kBatchStride = kBatch + 8;

struct BatchArrays {
  std::uint32_t* owner;
  std::uint32_t* partner;
  std::uint32_t* slot;
  std::uint32_t* source;  ///< where the history stood in the last step; any place when fresh
  std::uint8_t* fresh;
  double* difference[3];  ///< x_i − x_j
  double* normal[3];
  double* velocity[3];
  double* spin_sum[3];  ///< weighted (a_i ω_i + a_j ω_j) or plain sum
  double* spin_i[3];
  double* spin_j[3];
  double* overlap;
  double* radius_i;
  double* radius_j;
  double* radius;  ///< R*
  double* mass;    ///< m*
  double* arm_i;   ///< r_i − δ/2
  double* arm_j;
  double* force[3];
  double* torque_i[3];
  double* torque_j[3];
  double* moment_i[3];
  double* moment_j[3];
  double* normal_force;
  double* normal_stiffness;
  double* added_force;
  double* added_cap;
  double* restitution;
  double* friction;
  double* power[6];
  double* history[kMaxHistories];
};

}  // namespace millscope::dem
