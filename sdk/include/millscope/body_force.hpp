// Body forces: what acts on each bead by itself (gravity, drag, buoyancy).
#pragma once

#include "millscope/abi.hpp"

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

struct BodyForceTable {
  Status (*create)(const Values*, void** self, Failure*);
  void (*destroy)(void* self);
  /// 1 and fills acceleration (m/s²) when the force is the same acceleration for every bead; 0 otherwise (then evaluate is called).
  std::int32_t (*uniform)(const void* self, double time, double acceleration[3]);
  void (*evaluate)(const void* self, BodyForceBatch*);
};

inline constexpr std::uint64_t kBodyForceLayout =
    hash_numbers({4, sizeof(BodyForceBatch), sizeof(BodyForceTable), sizeof(Value), sizeof(Parameter), offsetof(BodyForceBatch, force)});

}  // namespace millscope
