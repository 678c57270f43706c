#include "kernel/dem/pair_lists.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace millscope::dem {

PairListView PairList::view() {
  PairListView v{};
  v.count = count();
  v.owner = owner.data();
  v.partner = partner.data();
  v.touching = touching.data();
  v.history_count = static_cast<std::int32_t>(history.size());
  for (int h = 0; h < v.history_count; ++h) {
    v.history[h] = history[h].data();
    v.next[h] = next[h].data();
  }
  return v;
}

std::int64_t PairList::contact_count() const { return std::count(touching.begin(), touching.end(), 1); }

void PairList::make_room(PairListView& v) {
  const std::int64_t needed = v.written + kBatch;
  for (int h = 0; h < v.history_count; ++h) {
    if (std::ssize(next[h]) < needed) next[h].resize(needed + needed / 8);
    v.next[h] = next[h].data();
  }
}

void PairLists::clear() {
  PairList empty;
  empty.history.resize(common_.layout.history_count());
  empty.next.resize(common_.layout.history_count());
  slabs_.assign(common_.slabs.count, SlabLists{std::vector<PairList>(common_.physics.count(), empty)});
}

std::int64_t PairLists::count() const {
  std::int64_t sum = 0;
  for (const SlabLists& slab : slabs_) {
    for (const PairList& list : slab.lists) sum += list.count();
  }
  return sum;
}

std::int64_t PairLists::first_touched(int slab) const {
  std::uint32_t first = static_cast<std::uint32_t>(common_.slabs.begin(slab));
  for (const PairList& list : slabs_[slab].lists) {
    for (const std::uint32_t partner : list.partner) first = std::min(first, partner);
  }
  return first;
}

void PairLists::add_work(const std::vector<std::uint32_t>& new_index, std::uint32_t listed, std::uint32_t touching,
                         std::vector<std::uint32_t>& work) const {
  common_.each_slab([&](int slab, int) {  // a slab owns beads of its own
    for (const PairList& list : slabs_[slab].lists) {
      for (std::int64_t s = 0; s < list.count(); ++s) work[new_index[list.owner[s]]] += listed + (list.touching[s] != 0 ? touching : 0);
    }
  });
}

/// Collects the histories of touching pairs by their owner in the new order; an exchanged owner flips the signs. Slabs work side by side,
/// so that the contacts of one owner come in any order; `append` puts them into that of the slots.
void PairLists::begin_rebuild(const CellOrder& order) {
  const std::vector<std::uint32_t>& new_index = order.new_index();
  const std::int64_t histories = common_.layout.history_count();
  carried_.start.assign(new_index.size() + 1, 0);
  const auto next = [](std::uint32_t& counter) { return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed); };
  common_.each_slab([&](int slab, int) {
    each_contact(slab, [&](const PairList& list, std::int64_t slot, std::int64_t) {
      next(carried_.start[std::max(new_index[list.owner[slot]], new_index[list.partner[slot]])]);
    });
  });
  std::exclusive_scan(carried_.start.begin(), carried_.start.end(), carried_.start.begin(), std::uint32_t{0});
  carried_.partner.resize(carried_.start.back());
  carried_.history.resize(carried_.start.back() * histories);
  carried_.filled.assign(carried_.start.begin(), carried_.start.end() - 1);
  common_.each_slab([&](int slab, int) {
    each_contact(slab, [&](const PairList& list, std::int64_t slot, std::int64_t contact) {
      const std::uint32_t i = new_index[list.owner[slot]], j = new_index[list.partner[slot]];
      const std::int64_t at = next(carried_.filled[std::max(i, j)]);
      carried_.partner[at] = std::min(i, j);
      for (std::int64_t h = 0; h < histories; ++h) {
        carried_.history[at * histories + h] = (i > j ? 1.0 : common_.layout.history_sign[h]) * list.history[h][contact];
      }
    });
  });
}

/// Makes the lists of one slab, in the memory of those before.
class PairLists::Builder {
 public:
  Builder(const Common& common, const Carried& carried, std::vector<PairList>& lists)
      : common_(common), carried_(carried), lists_(lists), count_(lists.size(), 0) {
    for (PairList& list : lists_) {
      for (auto& h : list.history) h.clear();
    }
  }

  void run(const CellOrder& order, BeadRange slab, const std::vector<std::uint8_t>& material) {
    std::int64_t cell = order.grid().cell_at(slab.begin);
    for (std::int64_t i = slab.begin; i < slab.end;) {
      while (order.grid().end_of(cell) <= i) ++cell;
      const Neighbourhood round = order.grid().round(cell);
      for (const std::int64_t end = std::min(slab.end, order.grid().end_of(cell)); i < end; ++i) {
        const std::uint32_t owner = static_cast<std::uint32_t>(i);
        if (common_.physics.material_count() == 1) {
          const int p = common_.physics.of_beads(0, 0);
          make_room(p, CellOrder::room(round));
          append(p, owner, order.near(i, round, lists_[p].partner.data() + count_[p]));
        } else {
          near_.resize(CellOrder::room(round));
          const std::int64_t count = order.near(i, round, near_.data());
          for (std::int64_t k = 0; k < count; ++k) {
            const int p = common_.physics.of_beads(material[i], material[near_[k]]);
            make_room(p, 1);
            lists_[p].partner[count_[p]] = near_[k];
            append(p, owner, 1);
          }
        }
      }
    }
    for (std::size_t p = 0; p < lists_.size(); ++p) resize(lists_[p], count_[p]);
  }

 private:
  static void resize(PairList& list, std::int64_t slots) {
    list.owner.resize(slots);
    list.partner.resize(slots);
    list.touching.resize(slots);
  }
  void make_room(int p, std::int64_t slots) {
    const std::int64_t needed = count_[p] + slots, held = static_cast<std::int64_t>(lists_[p].partner.capacity());
    if (lists_[p].count() < needed) resize(lists_[p], needed <= held ? std::min(held, needed + needed / 8) : needed + needed / 2);
  }

  /// Makes slots of the partners that stand behind the last slot, all of one owner, with the histories of the pairs that touched.
  void append(int p, std::uint32_t owner, std::int64_t partners) {
    PairList& list = lists_[p];
    const std::int64_t first = count_[p], last = count_[p] += partners;
    for (std::int64_t s = first; s < last; ++s) {
      list.owner[s] = owner;
      list.touching[s] = 0;
    }
    kept_.clear();
    for (std::uint32_t e = carried_.start[owner]; e < carried_.start[owner + 1]; ++e) {
      const auto end = list.partner.begin() + last, at = std::find(list.partner.begin() + first, end, carried_.partner[e]);
      if (at == end) continue;
      list.touching[at - list.partner.begin()] = 1;
      kept_.emplace_back(at - list.partner.begin(), e);
    }
    if (kept_.size() > 1) std::sort(kept_.begin(), kept_.end());
    const std::int64_t histories = std::ssize(list.history);
    for (const auto& [slot, e] : kept_) {
      for (std::int64_t h = 0; h < histories; ++h) list.history[h].push_back(carried_.history[e * histories + h]);
    }
  }

  const Common& common_;
  const Carried& carried_;
  std::vector<PairList>& lists_;
  std::vector<std::int64_t> count_;  ///< [list]: slots that are made
  std::vector<std::uint32_t> near_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> kept_;  ///< of one owner: slot and entry of each carried history
};

void PairLists::rebuild(int slab, const CellOrder& order, const std::vector<std::uint8_t>& material) {
  Builder(common_, carried_, slabs_[slab].lists).run(order, common_.slabs.range(slab), material);
}

}  // namespace millscope::dem
