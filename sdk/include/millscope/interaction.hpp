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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count),
                                       MILLSCOPE_MEMBER(S, time_step),
                                       MILLSCOPE_MEMBER(S, overlap),
                                       MILLSCOPE_MEMBER(S, normal),
                                       MILLSCOPE_MEMBER(S, velocity),
                                       MILLSCOPE_MEMBER(S, spin_i),
                                       MILLSCOPE_MEMBER(S, spin_j),
                                       MILLSCOPE_MEMBER(S, radius_i),
                                       MILLSCOPE_MEMBER(S, radius_j),
                                       MILLSCOPE_MEMBER(S, radius),
                                       MILLSCOPE_MEMBER(S, mass),
                                       MILLSCOPE_MEMBER(S, normal_force),
                                       MILLSCOPE_MEMBER(S, normal_stiffness),
                                       MILLSCOPE_MEMBER(S, history),
                                       MILLSCOPE_MEMBER(S, added_force),
                                       MILLSCOPE_MEMBER(S, added_cap),
                                       MILLSCOPE_MEMBER(S, moment_i),
                                       MILLSCOPE_MEMBER(S, moment_j),
                                       MILLSCOPE_MEMBER(S, elastic_sum),
                                       MILLSCOPE_MEMBER(S, power_sum)};
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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, info),  MILLSCOPE_MEMBER(S, create),   MILLSCOPE_MEMBER(S, destroy),
                                       MILLSCOPE_MEMBER(S, reach), MILLSCOPE_MEMBER(S, evaluate), MILLSCOPE_MEMBER(S, evaluate_scalar)};
};

inline constexpr std::uint64_t kInteractionLayout = layout_hash(Kind::interaction, {kMaxHistory, kMaxChannels, kLanes},
                                                                PairStructs<PairTermInfo, Channel, InteractionBatch, InteractionTable>{});

}  // namespace millscope
