// One oblique impact, followed in time: the law's ledger must close.
#pragma once

#include "millscope/conformance/contacts.hpp"

namespace millscope::conformance {

/// How far the ledger of one impact is from closing, relative to the impact's energy: Σ F·v Δt + ΔU + Σ power Δt, where the step's
/// velocity is that of its middle (leap-frog), the power is the step's own, and U is the elastic energy.
inline double ledger_error(const Held<ContactLawTable>& law, const Setting& setting, double time_step, bool grazing) {
  Contacts c(1);
  const double speed = setting.pair.typical_speed, mass = setting.pair.largest_mass;
  std::array<double, 3> velocity = {grazing ? 1.2 * speed : 0.2 * speed, 0.1 * speed, -(grazing ? 0.4 : 0.9) * speed};
  Contacts::put(c.normal, 0, {0, 0, 1});
  c.radius[0] = setting.pair.largest_radius;
  c.mass[0] = mass;
  c.friction[0] = 0.3;
  c.overlap[0] = 0.0;
  const double energy = 0.5 * mass * (velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2]);
  const double reach = law.table().reach(law.get(), c.radius[0]);
  double kinetic_before = energy, lost = 0.0, stored = 0.0;
  for (long step = 0; step < 100000; ++step) {
    c.overlap[0] -= velocity[2] * time_step;
    if (step > 2 && c.overlap[0] < -reach) break;
    Contacts::put(c.velocity, 0, velocity);
    c.step(law, time_step);
    double force_velocity = 0.0, force_square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double f = c.force[axis][0];
      force_velocity += f * velocity[axis];
      force_square += f * f;
      velocity[axis] += f / mass * time_step;
    }
    kinetic_before += force_velocity * time_step + 0.5 * force_square / mass * time_step * time_step;
    for (std::uint32_t k = 0; k < law.table().info.channel_count; ++k) lost += c.power[k][0] * time_step;
    stored = c.elastic_energy[0];
  }
  if (c.overlap[0] < -reach) stored = 0.0;
  return std::fabs(kinetic_before + lost + stored - energy) / energy;
}

/// The ledger closes at a fine time step and closes better at a finer one.
inline void check_ledger(const Held<ContactLawTable>& law, const Setting& setting, Violations& out) {
  const double dt = fine_step(law, setting.pair, 200);
  for (const bool grazing : {false, true}) {
    const double coarse = ledger_error(law, setting, dt, grazing), fine = ledger_error(law, setting, dt / 8, grazing);
    if (!(coarse <= setting.ledger_tolerance)) {
      out.push_back({"ledger", text_of("an impact leaves %g of its energy unaccounted (allowed %g)", coarse, setting.ledger_tolerance)});
    } else if (!(fine <= 0.5 * coarse || fine < 1e-4)) {
      out.push_back(
          {"ledger convergence", text_of("the error of an impact is %g, and still %g at an eighth of the time step", coarse, fine)});
    }
  }
}

}  // namespace millscope::conformance
