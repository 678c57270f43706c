// The state of a bead in cache-line records.
//
// Time levels (velocity Verlet in its leapfrog form, second order also for forces that depend on velocity):
//   x, predicted v and ω: step n;  half v and ω: step n − ½;  acceleration: step n − 1.
// The prediction is v(n−½) + ½ Δt (2 a(n−1) − a(n−2)). With a(n−1) alone it would lag by half a step's change of force, which always
// has the sign that makes damping look larger than it is: 2 % of the ledger at 14 steps per contact. But a bead in a bed is damped through
// all its contacts at once. With the sum Σc of their damping coefficients, a prediction that far ahead swings from step to step, and grows,
// where Σc Δt > m/2 (Σc R² Δt > I/2 in rotation, which comes first). So a bead whose acceleration has turned round in both of the last two
// steps is given v(n−½) itself, which bears Σc Δt < 2 m. Translation and rotation are judged together: a swing of the one below what is
// steady in the other is let go on until it is not. A smooth contact turns round once at a time and keeps its second order.
#pragma once

#include <cstdint>

namespace millscope::dem {

/// 32 bytes: centre (m) and radius (m).
struct alignas(32) PositionLine {
  double centre[3], radius;
};

/// 64 bytes: velocity (m/s), 1/m (1/kg), spin (rad/s), 1/I (1/(kg m²)).
struct alignas(64) MotionLine {
  double v[3], inverse_mass, w[3], inverse_inertia;
};

/// 64 bytes: force (N) and torque (N m); the fourth lanes are unused.
struct alignas(64) ForceLine {
  double f[3], unused_f, t[3], unused_t;
};

/// 32 bytes: linear (m/s²) and angular (rad/s²) acceleration of the last step. The fourth lane of `linear` is that step's a·a₋ + R² α·α₋
/// with the step before it: below 0, the bead had turned round. They only enter the prediction: single precision is ample.
struct alignas(32) AccelerationLine {
  float linear[4], angular[4];
};

/// 16 bytes: centre at the last list rebuild (m) and the square of the displacement that is allowed from there (m²).
struct alignas(16) ReferenceLine {
  float centre[3], allowed2;
};

/// Where the forces of a worker's beads stand while a step is made: those of all beads side by side, or, where beads are finished behind
/// the pair loop, a ring that is just long enough and stays in the cache. Lines are zero before the first force and after the last.
struct ForceWindow {
  ForceLine* lines = nullptr;
  std::int64_t mask = kAll;  ///< of a bead's number: `kAll`, or the length of a ring (a power of two) less one

  static constexpr std::int64_t kAll = -1;  ///< every bit is set, so that a masked number is the number itself
  static ForceWindow ring(ForceLine* lines, std::int64_t length) { return {lines, length - 1}; }
  bool is_ring() const { return mask != kAll; }
  ForceLine& operator[](std::int64_t bead) const { return lines[bead & mask]; }
};

/// Periodic lengths per axis (m); 0: not periodic.
struct PeriodicBox {
  double length[3];
};

}  // namespace millscope::dem
