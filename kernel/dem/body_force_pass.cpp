#include "kernel/dem/body_force_pass.hpp"

namespace millscope::dem {

void BodyForcePass::run(BeadRange beads) {
  gather(beads);
  evaluate(beads.end - beads.begin);
  scatter(beads);
}

void BodyForcePass::gather(BeadRange beads) {
  const BodyForceArrays& b = pass_.scratch.bodies;
  for (std::int64_t i = beads.begin; i < beads.end; ++i) {
    const std::int64_t k = i - beads.begin;
    const PositionLine& x = pass_.particles.position[i];
    const MotionLine& m = pass_.particles.motion[i];
    for (int a = 0; a < 3; ++a) {
      b.position[a][k] = x.centre[a];
      b.velocity[a][k] = m.v[a];
      b.spin[a][k] = m.w[a];
      b.force[a][k] = b.moment[a][k] = 0.0;
    }
    b.radius[k] = x.radius;
    b.mass[k] = 1.0 / m.inverse_mass;
    b.added_mass[k] = 0.0;
  }
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

/// The fluid that moves with a bead slows all that acts on it: (m + m_a) a = ΣF + m g, scaled so that the integrator's F/m + g gives that.
void BodyForcePass::scatter(BeadRange beads) {
  const BodyForceArrays& b = pass_.scratch.bodies;
  for (std::int64_t i = beads.begin; i < beads.end; ++i) {
    const std::int64_t k = i - beads.begin;
    ForceLine& line = pass_.force[i];
    for (int a = 0; a < 3; ++a) {
      line.f[a] += b.force[a][k];
      line.t[a] += b.moment[a][k];
    }
    if (b.added_mass[k] == 0.0) continue;
    const double mass = b.mass[k], ratio = mass / (mass + b.added_mass[k]);
    for (int a = 0; a < 3; ++a) line.f[a] = ratio * (line.f[a] + mass * acceleration_[a]) - mass * acceleration_[a];
  }
}

}  // namespace millscope::dem
