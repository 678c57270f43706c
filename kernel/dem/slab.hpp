// What one slab has of its own in a step, and its way through it on one worker.
#pragma once

#include <vector>

#include "kernel/dem/common.hpp"
#include "kernel/dem/ledger.hpp"
#include "kernel/dem/particles.hpp"
#include "kernel/dem/scratch.hpp"

namespace millscope::dem {

/// Pushes on beads of other workers, one by one in the order in which they were computed.
struct PushLog {
  std::vector<std::uint32_t> bead;
  AlignedVector<ForceLine> push;
  std::int64_t count = 0;

  void make_room() {  // for one more batch
    if (std::ssize(bead) >= count + kBatch) return;
    bead.resize(count + count / 2 + kBatch);
    push.resize(bead.size());
  }
};

struct alignas(kCacheLine) SlabState {
  PushLog log;                                     ///< of this step
  IntegrateResult result{false, -1};               ///< of this step
  Ledger ledger;                                   ///< since the start
  std::vector<std::vector<double>> impact, shear;  ///< [body][triangle], J since the start
  std::vector<std::vector<double>> worn;           ///< [body][triangle], m³ since Settings::wear_from_step
};

struct SlabPass {
  const Common& common;
  const Particles& particles;
  SlabState& state;
  Scratch& scratch;
  ForceWindow force;
  int slab;
  std::int64_t note_before;  ///< pushes on beads before this one are another worker's: they go into the log
  std::int64_t step;
};

}  // namespace millscope::dem
