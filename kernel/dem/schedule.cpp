#include "kernel/dem/schedule.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace millscope::dem {
namespace {

// Walls and phase B trail behind the pairs by this many batches: few enough that the beads between are still in the cache.
constexpr std::int64_t kTrail = 4;

}  // namespace

Schedule::Schedule(Common& common) : common_(common), slabs_(common.slabs.count) {
  for (int p = 0; p < common_.physics.count(); ++p) {
    if (common_.physics[p].wall) continue;
    last_list_ = p;
    ++list_count_;
  }
}

bool Schedule::trails_at(std::int64_t last, std::int64_t count) { return last < count && last % (kTrail * kBatch) == 0; }

/// How far each batch reaches, and the most beads that carry forces at once, in the order in which a step goes.
void Schedule::measure(int slab, const PairList& list) {
  SlabSchedule& schedule = slabs_[slab];
  const BeadRange beads = common_.slabs.range(slab);
  schedule.frontier.clear();
  std::int64_t finished = beads.begin, longest = 0, touched = beads.begin, frontier = beads.begin;
  for (std::int64_t first = 0; first < list.count(); first += kBatch) {
    const std::int64_t last = std::min(list.count(), first + kBatch);
    for (std::int64_t s = first; s < last; ++s) {
      const std::int64_t partner = list.partner[s];
      assert(list.owner[s] < partner);
      frontier = std::max(frontier, partner + 1);
      if (partner < beads.end) touched = std::max(touched, partner + 1);
    }
    schedule.frontier.push_back(static_cast<std::uint32_t>(frontier));
    longest = std::max(longest, touched - finished);
    if (trails_at(last, list.count())) {
      // Beads without pairs may lie before the next owner: walls and body forces reach them now.
      longest = std::max(longest, list.owner[last] - finished);
      finished = list.owner[last];
    }
  }
  longest = std::max(longest, beads.end - finished);
  const std::int64_t ring = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(longest)));
  schedule.ring = list_count_ == 1 && ring < beads.end - beads.begin ? ring : 0;
}

void Schedule::renew(const PairLists& pairs) {
  common_.each_slab([&](int slab, int) {
    measure(slab, pairs.of(slab, last_list_));
    slabs_[slab].halo_end = pairs.reach_end(slab);
  });
  for (int slab = 0; slab < common_.slabs.count; ++slab) {
    slabs_[slab].first_reference = slab;
    for (int earlier = slab - 1; earlier >= 0; --earlier) {
      if (slabs_[earlier].halo_end > common_.slabs.begin(slab)) slabs_[slab].first_reference = earlier;
    }
  }
}

std::int64_t Schedule::longest_ring() const {
  std::int64_t longest = 0;
  for (const SlabSchedule& slab : slabs_) longest = std::max(longest, slab.ring);
  return longest;
}

BeadRange Schedule::first_touched(int slab, std::int64_t first) const {
  const std::vector<std::uint32_t>& frontier = slabs_[slab].frontier;
  const std::int64_t batch = first / kBatch;
  if (batch >= std::ssize(frontier)) return {0, 0};
  return {batch == 0 ? common_.slabs.begin(slab) : frontier[batch - 1], frontier[batch]};
}

bool Schedule::follows_at_once(int slab, int worker) const {
  return slabs_[slab].first_reference >= common_.workers.first(worker, common_.slabs.count);
}

}  // namespace millscope::dem
