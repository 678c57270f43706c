// What a system is made of; internal to it.
#pragma once

#include "kernel/dem/step.hpp"
#include "kernel/dem/system.hpp"

namespace millscope::dem {

struct System::Parts {
  Parts(System& system, Settings settings, Layout layout, PhysicsTable physics)
      : common(std::move(settings), std::move(layout), std::move(physics)),
        order(common),
        pairs(common),
        walls(common, system.bodies),
        step(common, system.particles, pairs, walls, system.body_forces) {}

  /// For the beads and bodies that there are now: checks, empty lists and books.
  void prepare(const Particles& particles);
  /// Cuts the slabs anew, between the new order and the new lists.
  void share_work();

  Common common;
  CellOrder order;
  PairLists pairs;
  WallLists walls;
  Step step;
};

}  // namespace millscope::dem
