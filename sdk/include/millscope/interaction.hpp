// The table of an interaction: what acts on a pair besides its contact law.
#pragma once

#include "millscope/pair_term.hpp"

namespace millscope {

/// Interactions see both bodies' spins and may turn them.
struct InteractionBatch {
  std::int64_t count;
  double time_step;
  const double* overlap;
  const double* normal[3];
  const double* velocity[3];
  const double* spin_i[3];  ///< ω_i, rad/s
  const double* spin_j[3];
  const double* radius_i;          ///< m
  const double* radius_j;          ///< m; 0 for a wall
  const double* radius;            ///< R*
  const double* mass;              ///< m*
  const double* normal_force;      ///< post: total F_n of law and pre interactions
  const double* normal_stiffness;  ///< post
  double* history[kMaxHistory];
  double* added_force;  ///< pre, added to: force along n, N, positive pushes apart
  double* added_cap;    ///< pre, added to: N
  double* moment_i[3];  ///< post, added to: N m on i
  double* moment_j[3];  ///< post, added to: N m on j
  double elastic_sum;
  double power_sum[kMaxChannels];
};
template <>
struct Layout<InteractionBatch> {
  using S = InteractionBatch;
  static constexpr std::size_t offsets[] = {
      offsetof(S, count),     offsetof(S, time_step),    offsetof(S, overlap),          offsetof(S, normal),      offsetof(S, velocity),
      offsetof(S, spin_i),    offsetof(S, spin_j),       offsetof(S, radius_i),         offsetof(S, radius_j),    offsetof(S, radius),
      offsetof(S, mass),      offsetof(S, normal_force), offsetof(S, normal_stiffness), offsetof(S, history),     offsetof(S, added_force),
      offsetof(S, added_cap), offsetof(S, moment_i),     offsetof(S, moment_j),         offsetof(S, elastic_sum), offsetof(S, power_sum)};
};

struct InteractionTable {
  PairTermInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  double (*reach)(const void* self, double radius);
  void (*evaluate)(const void* self, InteractionBatch*);
  void (*evaluate_scalar)(const void* self, InteractionBatch*);
};
template <>
struct Layout<InteractionTable> {
  using S = InteractionTable;
  static constexpr std::size_t offsets[] = {offsetof(S, info),  offsetof(S, create),   offsetof(S, destroy),
                                            offsetof(S, reach), offsetof(S, evaluate), offsetof(S, evaluate_scalar)};
};

inline constexpr std::uint64_t kInteractionLayout =
    layout_hash(Kind::interaction, {kMaxHistory, kMaxChannels}, PairStructs<PairTermInfo, Channel, InteractionBatch, InteractionTable>{});

}  // namespace millscope
