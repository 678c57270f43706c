#include "kernel/run/soundness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/run/lifter_gap.hpp"

namespace millscope::run {
namespace {

using Json = nlohmann::ordered_json;

std::vector<DeepestContact> deepest_contacts(const Assembly& a) {
  std::vector<DeepestContact> out;
  const dem::Ledger ledger = a.system->ledger();
  for (std::size_t p = 0; p < ledger.pairs.size(); ++p) {
    const dem::PairPhysics& physics = a.system->physics()[p];
    out.push_back({physics.name, physics.wall, (physics.wall ? 1.0 : 0.5) * ledger.pairs[p].largest_overlap});
  }
  return out;
}

/// Σ m R / Σ m.
double mean_radius_by_mass(const config::Case& c) {
  double moment = 0, mass = 0;
  for (const config::BeadCase& bead : c.beads) {
    for (const config::SizeClass& size : bead.sizes) {
      const double m = bead.number_share * size.number_fraction * bead.density * config::sphere_volume(size.diameter);
      moment += m * 0.5 * size.diameter;
      mass += m;
    }
  }
  return moment / mass;
}

/// The narrowest of all bodies that turn.
std::optional<LifterGap> lifter_gap(const Assembly& a, double bead_radius) {
  std::optional<LifterGap> narrowest;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    if (!a.c.geometry[g].motion.rotation) continue;
    const std::optional<double> width = narrowest_lifter_gap(a.geometries[g].surface, a.geometries[g].interior, bead_radius);
    if (width && (!narrowest || *width < narrowest->width)) narrowest = LifterGap{a.c.geometry[g].plugin.name, *width};
  }
  return narrowest;
}

/// The drift of the power by torque or by the centre of mass: whichever is farther beyond the limits of `steady`, 3 errors and 1 %.
Drift drift_of(const Json& summary) {
  Drift most;
  double farthest = -1;
  for (const std::string by : {"torque", "com"}) {
    if (!summary["power_W"].contains(by)) continue;  // another engine does not tell it of a mill that repeats along x or y
    const double errors = summary["steadiness"][by + "_power_drift_standard_errors"].get<double>();
    const double part = std::abs(summary["steadiness"][by + "_power_drift_W"].get<double>() / summary["power_W"][by].get<double>());
    const double far = std::min(errors / 3, part / 0.01);
    if (far > farthest) {
      farthest = far;
      most = {errors, part};
    }
  }
  return most;
}

/// What of the window's energy nothing accounts for, as part of what goes through; nothing where nothing goes through.
std::optional<double> unaccounted_in(const Json& summary) {
  if (!summary.contains("energy")) return {};
  const Json& energy = summary["energy"];
  for (const char* key : {"wall_work_J", "dissipated_J", "imbalance_J"}) {
    if (!energy.contains(key) || !energy[key].is_number()) return {};
  }
  const double through = std::max(std::abs(energy["wall_work_J"].get<double>()), std::abs(energy["dissipated_J"].get<double>()));
  if (!(through > 0)) return {};
  return std::abs(energy["imbalance_J"].get<double>()) / through;
}

}  // namespace

Soundness soundness_of(const Assembly& a, const Json& summary) {
  Soundness s = soundness_of_means(a, summary);
  s.deepest = deepest_contacts(a);
  return s;
}

Soundness soundness_of_means(const Assembly& a, const Json& summary) {
  Soundness s = soundness_of_summary(summary, a.mill_speed);
  s.stiffness_factor = a.c.stiffness_factor;
  s.stiffness_from_young = a.stiffness_from_young;
  if (summary.contains("contact")) s.contact_steps = summary["contact"]["steps_per_shortest_contact"].get<double>();
  s.bead_radius = mean_radius_by_mass(a.c);
  s.gap = lifter_gap(a, s.bead_radius);
  return s;
}

Soundness soundness_of_summary(const Json& summary, double speed) {
  Soundness s;
  if (speed != 0) s.turn = 2 * std::numbers::pi / std::abs(speed);
  if (!summary.contains("window_s")) return s;
  s.window = summary["window_s"][1].get<double>() - summary["window_s"][0].get<double>();
  s.steady = summary["steady"].get<bool>();
  if (!s.steady) s.drift = drift_of(summary);
  if (summary.contains("energy") && summary["energy"]["wall_work_J"].get<double>() != 0)
    s.imbalance = summary["energy"]["imbalance_fraction"].get<double>();
  s.unaccounted = unaccounted_in(summary);
  if (!summary["power_W"].contains("com")) return s;
  const double power = summary["power_W"]["com"].get<double>(), error = summary["power_W"]["com_sem"].get<double>();
  if (power != 0 && std::isfinite(error)) s.power_error = error / std::abs(power);
  const double centre = std::hypot(summary["com_m_sem"][0].get<double>(), summary["com_m_sem"][1].get<double>());
  if (std::isfinite(centre)) s.centre_error = centre;
  return s;
}

}  // namespace millscope::run
