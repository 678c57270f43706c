// One list of pairs on its way through a step, batch by batch.
#pragma once

#include <optional>
#include <vector>

#include "kernel/dem/pair_lists.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {

/// Radius and mass of all beads of a pair of materials, where they are alike: then neither needs gathering.
struct Alike {
  double radius;        ///< m
  double reduced_mass;  ///< m*, kg
  /// R*, m* and R, one batch long: the same number everywhere. All slabs read them, nobody writes.
  AlignedVector<double> reduced_radii, reduced_masses, radii;
};
std::optional<Alike> alike_of(const Particles& particles, const PairPhysics& physics);

class PairSweep {
 public:
  PairSweep(const SlabPass& pass, int physics_index, PairList& list, const std::optional<Alike>& alike);

  std::int64_t count() const { return view_.count; }
  /// The contacts of the batch at slot `first`.
  void batch(std::int64_t first);
  void end() { list_.end_sweep(); }

 private:
  void look_ahead(std::int64_t first);

  const SlabPass& pass_;
  const PairPhysics& physics_;
  PairLedger& ledger_;
  PairList& list_;
  PairListView view_;
  PairBatch batch_;  ///< the worker's, with the constants of `Alike` in the place of four arrays where there are such
  GatherContext gather_;
};

}  // namespace millscope::dem
