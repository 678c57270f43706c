#include "kernel/dem/body_force_pass.hpp"

namespace millscope::dem {

void BodyForcePass::run(BeadRange beads) {
  const WideTable& wide = pass_.common.wide;
  wide.gather_bodies(pass_.particles.position.data(), pass_.particles.motion.data(), beads, pass_.scratch.bodies);
  evaluate(beads.end - beads.begin);
  wide.scatter_bodies(pass_.force, beads, acceleration_.data(), pass_.scratch.bodies);
}

void BodyForcePass::evaluate(std::int64_t count) {
  const BodyForceArrays& b = pass_.scratch.bodies;
  const double time_step = pass_.common.settings.time_step;
  for (std::int64_t f = 0; f < std::ssize(forces_); ++f) {
    double uniform[3];
    if (forces_[f].table->uniform(forces_[f].self, time_, uniform)) continue;
    BodyForceBatch batch{count,
                         time_,
                         time_step,
                         {b.position[0], b.position[1], b.position[2]},
                         {b.velocity[0], b.velocity[1], b.velocity[2]},
                         {b.spin[0], b.spin[1], b.spin[2]},
                         b.radius,
                         b.mass,
                         {b.force[0], b.force[1], b.force[2]},
                         {b.moment[0], b.moment[1], b.moment[2]},
                         b.added_mass,
                         0.0};
    forces_[f].table->evaluate(forces_[f].self, &batch);
    pass_.state.ledger.body_force_work[f] += batch.power_sum * time_step;
  }
}

}  // namespace millscope::dem
