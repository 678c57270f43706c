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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count),    MILLSCOPE_MEMBER(S, time),       MILLSCOPE_MEMBER(S, time_step),
                                       MILLSCOPE_MEMBER(S, position), MILLSCOPE_MEMBER(S, velocity),   MILLSCOPE_MEMBER(S, spin),
                                       MILLSCOPE_MEMBER(S, radius),   MILLSCOPE_MEMBER(S, mass),       MILLSCOPE_MEMBER(S, force),
                                       MILLSCOPE_MEMBER(S, moment),   MILLSCOPE_MEMBER(S, added_mass), MILLSCOPE_MEMBER(S, power_sum)};
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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, create), MILLSCOPE_MEMBER(S, destroy), MILLSCOPE_MEMBER(S, uniform),
                                       MILLSCOPE_MEMBER(S, evaluate)};
};

inline constexpr std::uint64_t kBodyForceLayout = layout_hash(Kind::body_force, {}, KindStructs<BodyForceBatch, BodyForceTable>{});

}  // namespace millscope
