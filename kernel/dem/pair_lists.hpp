// The lists of pairs: which beads are near one another, made anew at each rebuild, with the histories of the pairs that touch.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "kernel/dem/batch.hpp"
#include "kernel/dem/cell_order.hpp"

namespace millscope::dem {

/// Pairs of one slab and one pair of materials; what stands where: PairListView.
struct PairList {
  std::vector<std::uint32_t> owner, partner;
  std::vector<std::uint8_t> touching;
  std::vector<std::vector<double>> history;  ///< [number][contact]: of the touching slots, in their order; may have room to spare
  std::vector<std::vector<double>> next;     ///< the same of the step that is being made

  std::int64_t count() const { return std::ssize(owner); }
  std::int64_t contact_count() const;
  PairListView view();
  void make_room(PairListView& view);       ///< in `next` for one more batch
  void end_sweep() { history.swap(next); }  ///< `next` becomes `history`
};

class PairLists {
 public:
  explicit PairLists(Common& common) : common_(common) {}

  /// Empty lists.
  void clear();
  /// From here, slab by slab, `rebuild`: takes the histories out of the old lists.
  void begin_rebuild(const CellOrder& order, const std::vector<std::uint8_t>& material_of_bead);
  /// Lists, by new numbers, all pairs of a slab whose reaches overlap. The histories of touching pairs are carried over; where owner and
  /// partner change places, the numbers that a law declares odd change sign. Many slabs at once.
  void rebuild(int slab, const CellOrder& order, const std::vector<std::uint8_t>& material_of_bead);

  /// Adds to each owner's work, by its new number, that of its pairs.
  void add_work(const std::vector<std::uint32_t>& new_index, std::uint32_t listed, std::uint32_t touching,
                std::vector<std::uint32_t>& work) const;

  PairList& of(int slab, int physics_index) { return slabs_[slab].lists[physics_index]; }
  const PairList& of(int slab, int physics_index) const { return slabs_[slab].lists[physics_index]; }
  /// The first bead that pairs of a slab touch; its own first, where none touches an earlier one.
  std::int64_t first_touched(int slab) const;
  std::int64_t count() const;

  /// visit(list, slot, contact) for all pairs that touch: `contact` is the place in `history`.
  template <class Visit>
  void each_contact(const Visit& visit) const {
    for (int slab = 0; slab < std::ssize(slabs_); ++slab) each_contact(slab, visit);
  }
  template <class Visit>
  void each_contact(int slab, const Visit& visit) const {
    constexpr std::int64_t kAtOnce = 256;  // slots, of which first the touching ones are collected, without a branch
    std::int64_t touching[kAtOnce + 1];
    for (const PairList& list : slabs_[slab].lists) {
      std::int64_t contact = 0;
      for (std::int64_t first = 0; first < list.count(); first += kAtOnce) {
        std::int64_t found = 0;
        for (std::int64_t s = first, last = std::min(list.count(), first + kAtOnce); s < last; ++s) {
          touching[found] = s;
          found += list.touching[s];
        }
        for (std::int64_t k = 0; k < found; ++k) visit(list, touching[k], contact++);
      }
    }
  }

  /// For visitors of the state (state_visitors.hpp), in state.cpp.
  template <class Self, class Visit>
  static void each_array(Self& self, Visit& visit);

 private:
  struct alignas(kCacheLine) SlabLists {
    std::vector<PairList> lists;                    ///< [physics]; those with a wall stay empty
    std::vector<std::vector<std::uint32_t>> first;  ///< for a rebuild
  };
  /// Histories on their way to a new list, by the new number of the owner.
  struct Carried {
    std::vector<std::uint32_t> start;   ///< [owner]; one more at the end
    std::vector<std::uint32_t> filled;  ///< [owner]: behind the last one that stands there
    std::vector<std::uint32_t> partner;
    std::vector<double> history;  ///< [contact][number]
  };
  class Builder;
  Common& common_;
  std::vector<SlabLists> slabs_;
  std::optional<int> only_;  ///< where all beads are of one material: the list of all pairs
  Carried carried_;
};

}  // namespace millscope::dem
