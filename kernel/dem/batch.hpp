// Plain views that the contact loop works on: a list of pairs, and the arrays of one batch of contacts.
#pragma once

#include "kernel/dem/lines.hpp"

namespace millscope::dem {

/// Numbers that law, interactions and pair parameters may keep per contact, all together.
inline constexpr int kMaxHistories = 24;

/// One part of the pair list: all listed pairs of one slab and one pair of materials. Owner i > partner j. Histories stand in the order of
/// the slots, for the touching ones only: a sweep reads those of the last step and writes those of its own.
///
///     slot                        0  1  2  3  4  5  6
///     touching, last step         0  1  0  1  1  0  1      one entry for each slot
///     history[h], last step          a     b  c     d      one for each slot that touched: `read` counts those of the slots passed
///     within reach now            1  1  0  0  1  0  1      becomes `touching`
///     fresh                       1  0        0     0      the others find their history at `read`: slot 4 at 2, which is c
///     next[h], this step          n  a        c     d      one for each slot that touches: `written` counts them; b is dropped
struct PairListView {
  std::int64_t count;
  const std::uint32_t* owner;
  const std::uint32_t* partner;
  std::uint8_t* touching;                ///< 1 while within reach: ahead of the sweep that of the last step
  std::int64_t read, written;            ///< `search` advances the first, `scatter` the second, nobody else does
  const double* history[kMaxHistories];  ///< per contact of the last step
  double* next[kMaxHistories];           ///< per contact of this step: room for all that `written` plus one batch needs
  std::int32_t history_count;
};

inline constexpr std::int64_t kBatch = 512;  ///< slots of a list that make a batch
inline constexpr std::int64_t kPadding = 8;  ///< plugins get a multiple of this many contacts (kLanes of the SDK)
inline constexpr std::int64_t kBatchStride = kBatch + kPadding;

namespace {  // each build of wide.cpp has its own
constexpr std::int64_t padded_count(std::int64_t count) { return (count + kPadding - 1) / kPadding * kPadding; }
}  // namespace

/// Contacts as the plugins see them, of beads i with beads or walls j: structure of arrays, each `kBatchStride` long, 64-byte aligned.
struct ContactArrays {
  std::uint8_t* fresh;  ///< did not touch in the last step: no history
  double* normal[3];    ///< from j to i
  double* velocity[3];  ///< of the surface of i against that of j, m/s
  double* spin_i[3];    ///< rad/s; of two beads only where interactions need them
  double* spin_j[3];
  double* overlap;  ///< m
  double* radius_i;
  double* radius_j;  ///< 0: a wall
  double* radius;    ///< R*
  double* mass;      ///< m*
  double* force[3];  ///< on i, N
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

/// Contacts of beads with beads. Where all beads of a pair of materials are alike, the arrays of radii and masses are constants that all
/// slabs share (`Equality`), and `gather` leaves them alone.
struct PairBatch : ContactArrays {
  std::uint32_t* owner;
  std::uint32_t* partner;
  std::uint32_t* source;  ///< where the history stood in the last step; no place when fresh
  double* arm_i;          ///< r_i − δ/2
  double* arm_j;
  double* torque_i[3];
  double* torque_j[3];
};

/// Contacts of beads with one body.
struct WallBatch : ContactArrays {
  std::uint32_t* bead;
  std::uint32_t* contact;    ///< index into what the geometry found
  double* arm;               ///< from the bead's centre to the contact: r − δ/2
  double* lever[3];          ///< from the body's centre to the contact
  double* wall_velocity[3];  ///< of the body at the contact
  double* torque[3];         ///< on the bead
  double* body_torque[3];    ///< on the body, about its centre
  double* wall_power;        ///< of the body, W
  std::uint8_t* first;       ///< what wear laws are told: they came to touch in this step; …
  double* pressing;          ///< … force that presses the surfaces together, N
  double* sliding;           ///< … and the speed at which they slide, m/s
  double* worn;              ///< what they say: m³ of the body, in this step
};

/// Beads as body forces see them (BodyForceBatch), and what these answer; like the arrays above.
struct BodyForceArrays {
  double* position[3];
  double* velocity[3];
  double* spin[3];
  double* radius;
  double* mass;
  double* force[3];
  double* moment[3];
  double* added_mass;
};

}  // namespace millscope::dem
