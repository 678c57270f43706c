// The table of a wear_law: how much of a wall a bead takes away. It moves nothing: no force, no energy.
#pragma once

#include "millscope/pair_term.hpp"

namespace millscope {

/// Contacts of beads with one wall in one step. With films and adhesion come gaps, too: nothing presses or slides there.
struct WearBatch {
  std::int64_t count;
  double time_step;           ///< s
  const std::uint8_t* first;  ///< 1: they did not touch in the step before, so the velocity is that of the impact
  const double* normal[3];    ///< n, unit, from the wall to the bead
  const double* velocity[3];  ///< of the bead's surface against the wall's, m/s
  const double* radius;       ///< of the bead, m
  const double* mass;         ///< of the bead, kg
  const double* pressing;     ///< force that presses the surfaces together, as Coulomb's friction counts it, N, ≥ 0
  const double* sliding;      ///< speed at which they slide, m/s, ≥ 0: 0 while they stick
  double* volume;             ///< out: of the wall, m³, taken away in this step, ≥ 0
};
template <>
struct Layout<WearBatch> {
  using S = WearBatch;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count),  MILLSCOPE_MEMBER(S, time_step), MILLSCOPE_MEMBER(S, first),
                                       MILLSCOPE_MEMBER(S, normal), MILLSCOPE_MEMBER(S, velocity),  MILLSCOPE_MEMBER(S, radius),
                                       MILLSCOPE_MEMBER(S, mass),   MILLSCOPE_MEMBER(S, pressing),  MILLSCOPE_MEMBER(S, sliding),
                                       MILLSCOPE_MEMBER(S, volume)};
};

struct WearLawTable {
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  void (*evaluate)(const void* self, WearBatch*);
};
template <>
struct Layout<WearLawTable> {
  using S = WearLawTable;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, create), MILLSCOPE_MEMBER(S, destroy), MILLSCOPE_MEMBER(S, evaluate)};
};

inline constexpr std::uint64_t kWearLawLayout =
    layout_hash(Kind::wear_law, {}, KindStructs<Material, PairContext, WearBatch, WearLawTable>{});

}  // namespace millscope
