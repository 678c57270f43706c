// What one slab has of its own in a step, and its way through phase A on one worker.
#pragma once

#include <vector>

#include "kernel/dem/common.hpp"
#include "kernel/dem/ledger.hpp"
#include "kernel/dem/particles.hpp"
#include "kernel/dem/scratch.hpp"

namespace millscope::dem {

struct alignas(kCacheLine) SlabState {
  AlignedVector<ForceLine> halo;                   ///< forces on beads of later slabs, from the slab's end on; zero between steps
  ForceWindow force;                               ///< in use during this step
  IntegrateResult result{false, -1};               ///< of this step
  std::vector<std::int64_t> stretches;             ///< of this step: where walls and phase B pause behind the pairs; the slab's end is last
  Ledger ledger;                                   ///< since the start
  std::vector<std::vector<double>> impact, shear;  ///< [body][triangle], J since the start
};

struct SlabPass {
  const Common& common;
  const Particles& particles;
  SlabState& state;
  Scratch& scratch;
  int slab;
  std::int64_t step;
};

}  // namespace millscope::dem
