#include "kernel/dem/physics.hpp"

#include <utility>

namespace millscope::dem {

PhysicsTable::PhysicsTable(std::vector<PairPhysics> all, int material_count)
    : all_(std::move(all)), material_count_(material_count), of_beads_(material_count * material_count, -1), of_wall_(of_beads_) {
  for (int p = 0; p < count(); ++p) {
    const PairPhysics& physics = all_[p];
    reach_ = std::max(reach_, physics.reach);
    if (physics.wall) {
      of_wall_[physics.first * material_count + physics.second] = p;
      wall_reach_ = std::max(wall_reach_, physics.reach);
    } else {
      of_beads_[physics.first * material_count + physics.second] = p;
      of_beads_[physics.second * material_count + physics.first] = p;
    }
  }
}

}  // namespace millscope::dem
