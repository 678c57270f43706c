// What follows what in a step, found from new lists.
//
// Pairs are listed by owner, and partners come before their owner: when the pairs of a bead are reached, only those of later owners still
// push it. The walls follow behind the pairs; phase B follows behind the last pair that pushes a bead. The beads that carry forces at one
// moment are the stretch between the last bead that is finished and the present owner, and their forces fit into a ring of that length.
#pragma once

#include <algorithm>
#include <vector>

#include "kernel/dem/pair_lists.hpp"

namespace millscope::dem {

/// A pause behind some batches of the last list of a slab.
struct Trail {
  std::uint32_t passed;  ///< no bead before this one is an owner of pairs that are still to come: the walls may follow
  std::uint32_t done;    ///< no bead before this one is touched by a pair that is still to come, in any slab: phase B may follow
};

class Schedule {
 public:
  explicit Schedule(Common& common);

  /// After each rebuild.
  void renew(const PairLists& pairs, std::int64_t beads);

  /// The pair of materials whose list comes last in a slab: walls and phase B trail behind its pairs.
  int last_list() const { return last_list_; }
  /// Slots between two pauses.
  static constexpr std::int64_t kSlotsPerTrail = 4 * kBatch;  // few enough that the beads between are still in the cache
  /// Of a slab: behind each `kSlotsPerTrail` slots of the last list, and behind its end.
  const std::vector<Trail>& trails(int slab) const { return slabs_[slab].trails; }
  /// The first of the beads that pairs of this or of later slabs touch; of no slab (`slab` is their number) behind all beads.
  std::int64_t first_touched(int slab) const { return slab < common_.slabs.count ? slabs_[slab].first_touched : beads_; }
  /// Behind the last bead that carries forces at a pause.
  std::int64_t touched(int slab, const Trail& trail) const {
    return list_count_ == 1 ? std::min<std::int64_t>(trail.passed + std::int64_t{1}, beads_) : common_.slabs.end(slab);
  }
  /// Lines of the ring that serves a step, a power of two.
  std::int64_t ring() const { return ring_; }

 private:
  struct SlabSchedule {
    std::vector<Trail> trails;
    std::int64_t first_touched = 0;
  };
  void measure(int slab, const PairLists& pairs);

  Common& common_;
  int last_list_ = 0;
  int list_count_ = 0;  ///< pairs of materials of beads
  std::int64_t beads_ = 0, ring_ = 1;
  std::vector<SlabSchedule> slabs_;
};

}  // namespace millscope::dem
