#include "kernel/dem/schedule.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace millscope::dem {

Schedule::Schedule(Common& common) : common_(common), slabs_(common.slabs.count) {
  for (int p = 0; p < common_.physics.count(); ++p) {
    if (common_.physics[p].wall) continue;
    last_list_ = p;
    ++list_count_;
  }
}

/// The trails of a slab as if no other came behind it.
void Schedule::measure(int slab, const PairLists& pairs) {
  SlabSchedule& schedule = slabs_[slab];
  const PairList& list = pairs.of(slab, last_list_);
  const std::uint32_t slab_end = static_cast<std::uint32_t>(common_.slabs.end(slab));
  const std::int64_t pauses = list.count() == 0 ? 0 : (list.count() - 1) / kSlotsPerTrail;
  schedule.trails.assign(pauses + 1, {slab_end, slab_end});
  std::int64_t slot = list.count();
  for (std::int64_t t = pauses - 1; t >= 0; --t) {
    const std::int64_t begin = (t + 1) * kSlotsPerTrail;
    std::uint32_t done = schedule.trails[t + 1].done;
    while (slot > begin) {
      --slot;
      assert(list.partner[slot] < list.owner[slot]);
      done = std::min(done, list.partner[slot]);
    }
    schedule.trails[t] = {list.owner[begin], done};
  }
  schedule.first_touched = pairs.first_touched(slab);
}

void Schedule::renew(const PairLists& pairs, std::int64_t beads) {
  beads_ = beads;
  common_.each_slab([&](int slab, int) { measure(slab, pairs); });
  for (int slab = common_.slabs.count - 1; slab >= 0; --slab) {
    const std::int64_t later = first_touched(slab + 1);
    for (Trail& trail : slabs_[slab].trails) trail.done = static_cast<std::uint32_t>(std::min<std::int64_t>(trail.done, later));
    slabs_[slab].first_touched = std::min(slabs_[slab].first_touched, later);
  }
  // Phase B stops at a whole batch of beads. Where lists of several pairs of materials follow one another, all beads of a slab carry
  // forces.
  std::int64_t longest = 1, finished = 0;
  for (int slab = 0; slab < common_.slabs.count; ++slab) {
    for (const Trail& trail : slabs_[slab].trails) {
      longest = std::max(longest, touched(slab, trail) - finished);
      finished = std::max(finished, trail.done - kBatch);
    }
  }
  ring_ = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(longest)));
}

}  // namespace millscope::dem
