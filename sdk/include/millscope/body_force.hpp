// Body forces: what acts on each bead by itself (gravity, drag, buoyancy).
#pragma once

#include "millscope/layout.hpp"

namespace millscope {

/// Beads as arrays; force and moment are added to.
struct BodyForceBatch {
  std::int64_t count;
  double time;
  double time_step;
  const double* position[3];  ///< m
  const double* velocity[3];  ///< m/s
  const double* spin[3];      ///< rad/s
  const double* radius;       ///< m
  const double* mass;         ///< kg
  double* force[3];           ///< in/out, N
  double* moment[3];          ///< in/out, N m
  double* added_mass;         ///< in/out, kg: fluid that moves with the bead
  double power_sum;           ///< out: W taken from the beads (drag > 0)
};
template <>
struct Layout<BodyForceBatch> {
  using S = BodyForceBatch;
  static constexpr std::size_t offsets[] = {offsetof(S, count),    offsetof(S, time),   offsetof(S, time_step),  offsetof(S, position),
                                            offsetof(S, velocity), offsetof(S, spin),   offsetof(S, radius),     offsetof(S, mass),
                                            offsetof(S, force),    offsetof(S, moment), offsetof(S, added_mass), offsetof(S, power_sum)};
};

struct BodyForceTable {
  Status (*create)(const Values*, void** self, Failure*);
  void (*destroy)(void* self);
  /// 1 and fills acceleration (m/s²) when the force is the same acceleration for every bead; 0 otherwise (then evaluate is called).
  std::int32_t (*uniform)(const void* self, double time, double acceleration[3]);
  void (*evaluate)(const void* self, BodyForceBatch*);
};
template <>
struct Layout<BodyForceTable> {
  using S = BodyForceTable;
  static constexpr std::size_t offsets[] = {offsetof(S, create), offsetof(S, destroy), offsetof(S, uniform), offsetof(S, evaluate)};
};

inline constexpr std::uint64_t kBodyForceLayout = layout_hash(Kind::body_force, {}, KindStructs<BodyForceBatch, BodyForceTable>{});

}  // namespace millscope
