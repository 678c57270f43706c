// The parts of the contact loop that are built once per instruction set. Plain pointers in and out; the same bits from each build.
#pragma once

#include "kernel/dem/batch.hpp"

namespace millscope::dem {

/// Beads one after the other, in the order of cells.
struct BeadRange {
  std::int64_t begin, end;
};

/// Where beads are and how far they reach, for a rebuild, which may list a pair too many but none too few: singles, relative to a corner,
/// with what rounding may hide in the reach. They can be read up to kNearLanes behind the last.
struct NearPlaces {
  const float* centre[3];  ///< m
  const float* reach;      ///< m
};
inline constexpr std::int64_t kNearLanes = 8;

/// Where pairs are listed.
struct NearSlots {
  std::uint32_t *owner, *partner;  ///< [slot]
  std::uint32_t* first;            ///< [owner]: its first slot
};

/// What a gather needs besides the list.
struct GatherContext {
  const PositionLine* position;
  const MotionLine* motion;
  PeriodicBox box;
  double reach;   ///< gap up to which a pair counts, m
  bool equal;     ///< all beads of this pair of materials have the same radius and mass
  bool spins;     ///< also fill spin_i, spin_j (interactions need them)
  double radius;  ///< when equal
  double mass;    ///< m*, when equal
  /// Beads that the batches to come will touch first: `search` asks for their lines in passing.
  std::int64_t ahead, ahead_end;
  const ForceLine* ahead_force;  ///< where the force of bead `ahead` stands; nullptr: those lines are in the cache already
};

struct ScatterContext {
  ForceWindow force;
  bool equal;  ///< torque_i serves both
  /// Pushes on beads before `own_begin`, which another worker has, are noted one by one; nullptr: there are none.
  std::uint32_t* noted_bead;
  ForceLine* noted_push;
  std::int64_t own_begin;
};

struct IntegrateContext {
  PositionLine* position;
  MotionLine* motion;
  MotionLine* half;
  ForceWindow force;
  AccelerationLine* last;  ///< of the last step, replaced
  const ReferenceLine* reference;
  std::int64_t begin, end;
  double time_step;
  double acceleration[3];  ///< uniform, m/s²
  double largest_step2;    ///< square of the largest credible displacement in one step, m²
};

/// Where a body is and how it moves, as plain numbers (Pose).
struct WallPose {
  double rotation[3][3];
  double offset[3], centre[3], velocity[3], omega[3];
};

/// What the batch of contacts with a body is filled from: beads, and what the geometry found.
struct WallGather {
  const PositionLine* position;
  const MotionLine* motion;
  const double* overlap;
  const double* normal[3];  ///< in the body's frame
};

/// What contacts do to a body; the fourth numbers are unused.
struct WallSums {
  double force[4], torque[4];  ///< N; N m about its centre
  double power;                ///< W, of the body
};

/// What a step found out about a slab.
struct IntegrateResult {
  bool rebuild;          ///< some bead used up its skin (or is not finite)
  std::int64_t runaway;  ///< the first bead that moved too far in this one step, or −1
};

struct WideTable {
  const char* name;
  /// Finds the pairs of slots [first, last) that are within reach; fills owner, partner, source, fresh; advances `read`. Returns their
  /// number.
  std::int64_t (*search)(const GatherContext&, PairListView&, std::int64_t first, std::int64_t last, PairBatch&);
  /// Fills overlap, normal, velocity, radius, mass (padded), history; spins where interactions need them.
  void (*gather)(const GatherContext&, const PairListView&, std::int64_t count, PairBatch&);
  /// Adds force × arms (and moments when `with_moments`) to the beads, stores histories; advances `written`. Returns the number of pushes
  /// that it noted.
  std::int64_t (*scatter)(const ScatterContext&, PairListView&, std::int64_t count, bool with_moments, PairBatch&);
  /// Places of the world into the frame of a body.
  void (*to_frame)(const WallPose&, std::int64_t count, double* const (&position)[3]);
  /// From `bead` and `contact` of each place: all that the plugins need but the histories (padded).
  void (*gather_walls)(const WallGather&, const WallPose&, std::int64_t count, WallBatch&);
  /// Adds force and torque (and moments when `with_moments`) to the beads and to what the body gets.
  void (*scatter_walls)(const WallPose&, const ForceWindow&, std::int64_t count, bool with_moments, WallBatch&, WallSums&);
  /// Beads for body forces; force, moment and added mass are 0.
  void (*gather_bodies)(const PositionLine*, const MotionLine*, BeadRange, const BodyForceArrays&);
  /// What body forces answered, on top of all that the contacts push; `acceleration` of those that are uniform, m/s².
  void (*scatter_bodies)(const ForceWindow&, BeadRange, const double* acceleration, const BodyForceArrays&);
  /// Kick, drift, predict; clears the forces.
  IntegrateResult (*integrate)(const IntegrateContext&);
  /// Lists for each of some owners i the j < i of `count` ranges with |x_i − x_j| < reach_i + reach_j. Returns how many pairs they are;
  /// behind them up to kNearLanes slots are overwritten.
  std::int64_t (*near)(const NearPlaces&, const PeriodicBox&, BeadRange owners, const BeadRange* ranges, int count, const NearSlots&);
};

/// The best build that this machine runs, or the one asked for ("v2", "v3", "v4"; "" for the best).
const WideTable& wide_table(const char* wanted = "");

extern const WideTable wide_v2;
extern const WideTable wide_v3;
extern const WideTable wide_v4;

}  // namespace millscope::dem
