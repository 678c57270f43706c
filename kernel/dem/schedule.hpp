// What follows what in a step, found from new lists: how far each batch of pairs reaches, and when a bead is done with.
//
// Pairs are listed by owner, and an owner comes before its partners: once the pairs of a slab have passed a bead, only earlier slabs may
// still push it. Walls and phase B trail behind the pairs; the beads that carry forces at one moment are the stretch between the last
// bead that is finished and the farthest that a pair has touched, and their forces fit into a ring of that length.
#pragma once

#include <vector>

#include "kernel/dem/pair_lists.hpp"

namespace millscope::dem {

class Schedule {
 public:
  explicit Schedule(Common& common);

  /// After each rebuild.
  void renew(const PairLists& pairs);

  /// The pair of materials whose list comes last in a slab: its pairs are the ones that walls and phase B trail behind.
  int last_list() const { return last_list_; }
  /// True when walls and phase B follow behind the slots [0, last) of `count`.
  static bool trails_at(std::int64_t last, std::int64_t count);
  /// Lines of the ring that serves a slab, a power of two; 0: all its lines side by side are no longer.
  std::int64_t ring(int slab) const { return slabs_[slab].ring; }
  std::int64_t longest_ring() const;
  /// The beads that the batch at slot `first` of the last list will be the first to touch; empty where there is no such batch.
  BeadRange first_touched(int slab, std::int64_t first) const;
  /// Beads of later slabs that this one pushes: they begin at its end.
  std::int64_t halo_size(int slab) const { return slabs_[slab].halo_end - common_.slabs.end(slab); }
  /// The earliest slab that pushes beads of this one.
  int first_reference(int slab) const { return slabs_[slab].first_reference; }
  /// Phase B of a slab may follow phase A at once: the slabs that push it have been through A on the same worker.
  bool follows_at_once(int slab, int worker) const;

 private:
  struct SlabSchedule {
    /// [batch of the last list]: the frontier behind it, which is the first bead that no pair has touched yet.
    std::vector<std::uint32_t> frontier;
    std::int64_t ring = 0;
    std::int64_t halo_end = 0;
    int first_reference = 0;  ///< the earliest slab with a pair that reaches into this one
  };
  void measure(int slab, const PairList& list);

  Common& common_;
  int last_list_ = 0;
  int list_count_ = 0;  ///< pairs of materials of beads
  std::vector<SlabSchedule> slabs_;
};

}  // namespace millscope::dem
