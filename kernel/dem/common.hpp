// What all parts of a system read: what it was made of, who works on it, and how its beads are cut into slabs.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include "kernel/dem/physics.hpp"
#include "kernel/dem/settings.hpp"
#include "kernel/dem/wide.hpp"
#include "kernel/dem/workers.hpp"

namespace millscope::dem {

/// Beads one after the other, in the order of cells.
struct BeadRange {
  std::int64_t begin, end;
};

/// The cut of the beads into K slabs of equal numbers: the same for any number of threads.
struct Slabs {
  int count;
  std::int64_t beads = 0;

  std::int64_t begin(int slab) const { return slab * beads / count; }
  std::int64_t end(int slab) const { return begin(slab + 1); }
  BeadRange range(int slab) const { return {begin(slab), end(slab)}; }
};

struct Common {
  Common(Settings s, Layout l, PhysicsTable p)
      : settings(std::move(s)),
        layout(std::move(l)),
        physics(std::move(p)),
        wide(wide_table(settings.instruction_set.c_str())),
        workers(std::min(settings.threads, settings.partitions)),
        slabs{settings.partitions} {}

  /// Runs task(slab, worker) for all slabs.
  void each_slab(const std::function<void(int slab, int worker)>& task) { workers.run(slabs.count, task); }

  const Settings settings;
  const Layout layout;
  const PhysicsTable physics;
  const WideTable& wide;
  Workers workers;
  Slabs slabs;  ///< of the beads that there are
};

}  // namespace millscope::dem
