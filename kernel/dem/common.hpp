// What all parts of a system read: what it was made of, who works on it, and how its beads are cut into slabs.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "kernel/dem/physics.hpp"
#include "kernel/dem/settings.hpp"
#include "kernel/dem/wide.hpp"
#include "kernel/dem/workers.hpp"

namespace millscope::dem {

/// The cut of the beads into K slabs: the same for any number of threads.
struct Slabs {
  int count;
  std::vector<std::int64_t> bounds = std::vector<std::int64_t>(count + 1, 0);  ///< [slab]: its first bead; one more at the end

  std::int64_t begin(int slab) const { return bounds[slab]; }
  std::int64_t end(int slab) const { return bounds[slab + 1]; }
  BeadRange range(int slab) const { return {begin(slab), end(slab)}; }

  /// Equal numbers of beads.
  void cut_equally(std::int64_t beads) {
    for (int k = 0; k <= count; ++k) bounds[k] = k * beads / count;
  }
  /// About equal work, of which each bead has so much.
  void cut(const std::vector<std::uint32_t>& work);
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
