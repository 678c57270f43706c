// Order and pair lists of some beads by themselves; no plugin, no step.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/dem/pair_lists.hpp"

namespace dem_test {

using namespace millscope::dem;

/// From −half to half along each axis, m.
inline Settings open_box(double half, int partitions) {
  Settings s;
  s.time_step = 1e-5;
  s.partitions = partitions;
  for (int a = 0; a < 3; ++a) {
    s.low[a] = -half;
    s.high[a] = half;
  }
  return s;
}

inline PhysicsTable one_material() {
  PairPhysics beads, wall;
  wall.second = 1;
  wall.wall = true;
  return {{beads, wall}, 2};
}

/// Without a wall.
inline PhysicsTable two_materials() {
  PairPhysics same, mixed, other;
  mixed.second = 1;
  other.first = other.second = 1;
  return {{same, mixed, other}, 2};
}

/// Two numbers per contact, the second odd: it changes sign when owner and partner change places.
inline const Layout kOneEvenOneOdd{{}, {1, -1}};

/// Order and pair lists of some beads, and what they keep.
struct Lists {
  explicit Lists(Particles beads, int partitions = 4) : Lists(std::move(beads), open_box(1, partitions), one_material()) {}
  Lists(Particles beads, const Settings& settings, PhysicsTable physics)
      : common(settings, kOneEvenOneOdd, std::move(physics)), order(common), pairs(common), particles(std::move(beads)) {
    common.slabs.cut_equally(particles.count());
    pairs.clear();
    rebuild();
  }
  void rebuild() {
    order.renew(particles, 0);
    pairs.begin_rebuild(order, particles.material);
    common.each_slab([&](int slab, int) { pairs.rebuild(slab, order, particles.material); });
  }
  /// Makes all pairs touch that overlap; the numbers say which pair it is, as seen from its owner.
  void touch() {
    for (int slab = 0; slab < common.slabs.count; ++slab) {
      for (int p = 0; p < common.physics.count(); ++p) touch(pairs.of(slab, p));
    }
  }
  void touch(PairList& list) {
    for (auto& h : list.history) h.clear();
    for (std::int64_t s = 0; s < list.count(); ++s) {
      const std::uint32_t i = list.owner[s], j = list.partner[s];
      list.touching[s] = distance(i, j) < particles.position[i].radius + particles.position[j].radius;
      if (!list.touching[s]) continue;
      list.history[0].push_back(name(i, j));
      list.history[1].push_back(particles.id[i] < particles.id[j] ? name(i, j) : -name(i, j));
    }
  }
  double name(std::uint32_t i, std::uint32_t j) const {
    const auto [small, large] = std::minmax(particles.id[i], particles.id[j]);
    return 1000.0 * small + large + 1;
  }
  double distance(std::uint32_t i, std::uint32_t j) const {
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = particles.position[i].centre[a] - particles.position[j].centre[a];
      square += d * d;
    }
    return std::sqrt(square);
  }

  Common common;
  CellOrder order;
  PairLists pairs;
  Particles particles;
};

}  // namespace dem_test
