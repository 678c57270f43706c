// Scratch and results of slabs and workers; internal to the core.
#pragma once

#include "kernel/dem/scratch.hpp"
#include "kernel/dem/system.hpp"

namespace millscope::dem {

struct SlabState {
  std::vector<PairList> lists;  ///< one per pair of materials (those with a wall stay empty)
  AlignedVector<ForceLine> halo;
  ForceWindow force;                    ///< in use during this step
  std::vector<std::uint32_t> frontier;  ///< [batch of the last list]: the first bead that it and earlier ones do not touch
  std::int64_t ring = 0;                ///< lines that a ring needs, a power of two; 0: the slab is no longer than that
  std::vector<WallSlab> walls;          ///< one per body
  Ledger ledger;
  std::vector<std::vector<double>> impact, shear;  ///< [body][triangle], J
  IntegrateResult result{false, -1};
};

/// One list of pairs on its way through a step.
struct System::PairSweep {
  int slab;
  std::size_t physics;
  PairListView list;
  PairBatch batch;
  GatherContext gather;
};

/// Runs all physics of one pair of materials over a batch whose geometry and histories are filled, and books it.
struct BatchRun {
  const PairPhysics* physics;
  double time_step;
  std::int64_t count;
  bool per_contact;  ///< fill batch.power of each contact
};
void evaluate(const BatchRun& run, ContactArrays& batch, PairLedger& ledger);

/// Books first touches and, now and then, the largest overlap.
void count_collisions(std::int64_t count, const ContactArrays& batch, PairLedger& ledger);
void note_overlap(std::int64_t count, const ContactArrays& batch, PairLedger& ledger);

}  // namespace millscope::dem
