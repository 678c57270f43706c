// An interaction on one pair, through its table.
#pragma once

#include "laws/plugins.hpp"

namespace laws_test {

/// One pair in a batch of eight slots; the others are padding.
struct OnePair {
  double overlap[8], normal[3][8]{}, velocity[3][8]{}, spin_i[3][8]{}, spin_j[3][8]{}, radius_i[8], radius_j[8], radius[8], mass[8];
  double force[8]{}, stiffness[8]{}, history[kMaxHistory][8]{}, added_force[8]{}, added_cap[8]{}, moment_i[3][8]{}, moment_j[3][8]{};
  InteractionBatch batch{};

  OnePair() {
    for (int k = 0; k < 8; ++k) overlap[k] = -1, radius_i[k] = radius_j[k] = 5e-3, radius[k] = 2.5e-3, mass[k] = 1e-3;
    overlap[0] = 1e-5;
    normal[0][0] = 1.0;
    force[0] = 2.0;
    stiffness[0] = 1e4;
    batch.count = 8;
    batch.time_step = 1e-5;
    batch.overlap = overlap;
    batch.radius_i = radius_i, batch.radius_j = radius_j, batch.radius = radius, batch.mass = mass;
    batch.normal_force = force, batch.normal_stiffness = stiffness;
    batch.added_force = added_force, batch.added_cap = added_cap;
    for (int h = 0; h < kMaxHistory; ++h) batch.history[h] = history[h];
    for (int a = 0; a < 3; ++a) {
      batch.normal[a] = normal[a], batch.velocity[a] = velocity[a], batch.spin_i[a] = spin_i[a], batch.spin_j[a] = spin_j[a];
      batch.moment_i[a] = moment_i[a], batch.moment_j[a] = moment_j[a];
    }
  }

  void evaluate(const std::string& name, const std::string& text, const PairContext& context = bead_pair()) {
    const Descriptor& d = plugin(name);
    const ValueSet values = values_of(d, text);
    const Held<InteractionTable> held(*static_cast<const InteractionTable*>(d.table), values.view(), context);
    for (int a = 0; a < 3; ++a) moment_i[a][0] = moment_j[a][0] = 0;
    held.table().evaluate(held.get(), &batch);
  }
};

}  // namespace laws_test
