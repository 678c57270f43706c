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
  slabs_.assign(common_.slabs.count, SlabLists{std::vector<PairList>(common_.physics.count(), empty), {}});
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
/// so that the contacts of one owner come in any order; `take_over` puts them into that of the slots.
void PairLists::begin_rebuild(const CellOrder& order, const std::vector<std::uint8_t>& material) {
  only_.reset();
  if (!material.empty() && std::count(material.begin(), material.end(), material[0]) == std::ssize(material))
    only_ = common_.physics.of_beads(material[0], material[0]);
  const std::vector<std::uint32_t>& new_index = order.new_index();
  const std::int64_t histories = common_.layout.history_count();
  carried_.start.assign(new_index.size() + 1, 0);
  const bool alone = common_.workers.count() == 1;
  const auto next = [alone](std::uint32_t& counter) {
    return alone ? counter++ : std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
  };
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

/// Makes the lists of one slab, in the memory of those before: first the slots, then which of them touch, with their histories.
class PairLists::Builder {
 public:
  Builder(const PairLists& all, SlabLists& own, BeadRange slab)
      : common_(all.common_), only_(all.only_), lists_(own.lists), first_(own.first), slab_(slab) {
    first_.resize(lists_.size());
    for (auto& slots : first_) slots.resize(slab.end - slab.begin + 1);
    count_.assign(lists_.size(), 0);
  }

  void list(const CellOrder& order, const std::vector<std::uint8_t>& material) {
    constexpr std::int64_t kRoom = 16384;  // slots that are kept free at once: a cell of small beads among large ones has thousands
    std::int64_t cell = order.grid().cell_at(slab_.begin);
    for (BeadRange owners{slab_.begin, slab_.begin}; owners.begin < slab_.end;) {
      while (order.grid().end_of(cell) <= owners.begin) ++cell;
      const std::int64_t end = std::min(slab_.end, order.grid().end_of(cell));
      const Neighbourhood round = order.grid().round(cell);
      for (; owners.begin < end; owners.begin = owners.end) {
        owners.end = std::min(end, owners.begin + std::max<std::int64_t>(1, kRoom / round.beads));
        if (only_) {
          list_all(order, round, owners);
        } else {
          list_by_material(order, round, owners, material);
        }
      }
    }
    for (std::size_t p = 0; p < lists_.size(); ++p) {
      first_[p][slab_.end - slab_.begin] = static_cast<std::uint32_t>(count_[p]);
      resize(lists_[p], count_[p]);
      std::fill(lists_[p].touching.begin(), lists_[p].touching.end(), 0);
    }
  }

  void take_over(const Carried& carried, const std::vector<std::uint8_t>& material) {
    count_.assign(lists_.size(), 0);  // of contacts from here on
    std::vector<std::uint32_t> entries;
    for (std::int64_t i = slab_.begin; i < slab_.end; ++i) {
      entries.resize(carried.start[i + 1] - carried.start[i]);
      std::iota(entries.begin(), entries.end(), carried.start[i]);
      // As their slots stand.
      std::sort(entries.begin(), entries.end(), [&](std::uint32_t a, std::uint32_t b) { return carried.partner[a] < carried.partner[b]; });
      for (const std::uint32_t e : entries) {
        take_over(carried, e, i, only_ ? *only_ : common_.physics.of_beads(material[i], material[carried.partner[e]]));
      }
    }
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

  void list_all(const CellOrder& order, const Neighbourhood& round, BeadRange owners) {
    const int p = *only_;
    make_room(p, CellOrder::room(owners, round));
    PairList& list = lists_[p];
    std::uint32_t* const first = first_[p].data() + (owners.begin - slab_.begin);
    const std::int64_t before = count_[p];
    count_[p] += order.near(owners, round, {list.owner.data() + before, list.partner.data() + before, first});
    for (std::int64_t k = 0; k < owners.end - owners.begin; ++k) first[k] += static_cast<std::uint32_t>(before);
  }

  void list_by_material(const CellOrder& order, const Neighbourhood& round, BeadRange owners, const std::vector<std::uint8_t>& material) {
    for (std::int64_t i = owners.begin; i < owners.end; ++i) {
      for (std::size_t p = 0; p < lists_.size(); ++p) first_[p][i - slab_.begin] = static_cast<std::uint32_t>(count_[p]);
      const BeadRange owner{i, i + 1};
      owner_.resize(CellOrder::room(owner, round));
      partner_.resize(owner_.size());
      std::uint32_t first;
      const std::int64_t count = order.near(owner, round, {owner_.data(), partner_.data(), &first});
      for (std::int64_t k = 0; k < count; ++k) {
        const int p = common_.physics.of_beads(material[i], material[partner_[k]]);
        make_room(p, 1);
        lists_[p].owner[count_[p]] = static_cast<std::uint32_t>(i);
        lists_[p].partner[count_[p]++] = partner_[k];
      }
    }
  }

  /// One history, if its pair is still near.
  void take_over(const Carried& carried, std::int64_t entry, std::int64_t owner, int p) {
    PairList& list = lists_[p];
    const std::uint32_t* const first = first_[p].data() + (owner - slab_.begin);
    for (std::uint32_t slot = first[0]; slot < first[1]; ++slot) {
      if (list.partner[slot] != carried.partner[entry]) continue;
      list.touching[slot] = 1;
      const std::int64_t contact = count_[p]++, histories = common_.layout.history_count();
      for (std::int64_t h = 0; h < histories; ++h) {
        std::vector<double>& history = list.history[h];
        if (std::ssize(history) == contact) history.resize(contact + contact / 4 + 64);
        history[contact] = carried.history[entry * histories + h];
      }
      return;
    }
  }

  const Common& common_;
  const std::optional<int> only_;
  std::vector<PairList>& lists_;
  std::vector<std::vector<std::uint32_t>>& first_;  ///< [list][owner in the slab; one more at the end]: its first slot
  BeadRange slab_;
  std::vector<std::int64_t> count_;  ///< [list]: slots, or contacts, that are made
  std::vector<std::uint32_t> owner_, partner_;
};

void PairLists::rebuild(int slab, const CellOrder& order, const std::vector<std::uint8_t>& material) {
  Builder builder(*this, slabs_[slab], common_.slabs.range(slab));
  builder.list(order, material);
  builder.take_over(carried_, material);
}

}  // namespace millscope::dem
