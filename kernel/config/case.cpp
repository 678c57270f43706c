// What follows from a case: means, extremes, the number of beads.
#include "kernel/config/case.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/config/units.hpp"

namespace millscope::config {
namespace {

constexpr double kLargestCount = 4e9;

double extreme_diameter(const Case& c, bool largest) {
  double result = largest ? 0 : kUnbounded;
  for (const BeadCase& bead : c.beads) {
    for (const SizeClass& size : bead.sizes) result = largest ? std::max(result, size.diameter) : std::min(result, size.diameter);
  }
  return result;
}

}  // namespace

double sphere_volume(double diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }

double BeadCase::mean_volume() const {
  double volume = 0;
  for (const SizeClass& size : sizes) volume += size.number_fraction * sphere_volume(size.diameter);
  return volume;
}

const MaterialCase& Case::material(std::string_view material_name) const {
  for (const MaterialCase& m : materials) {
    if (m.name == material_name) return m;
  }
  throw UserError(fmt::format("{}: no material '{}'", file, material_name));
}

double Case::largest_diameter() const { return extreme_diameter(*this, true); }
double Case::smallest_diameter() const { return extreme_diameter(*this, false); }

double Case::mean_bead_volume() const {
  double volume = 0;
  for (const BeadCase& bead : beads) volume += bead.number_share * bead.mean_volume();
  return volume;
}

double Case::mean_bead_mass() const {
  double mass = 0;
  for (const BeadCase& bead : beads) mass += bead.number_share * bead.density * bead.mean_volume();
  return mass;
}

bool Case::has_tracers() const {
  return std::any_of(beads.begin(), beads.end(), [](const BeadCase& bead) { return bead.tracer; });
}

bool Case::may_be_followed(double radius, double bead_mass) const { return !has_tracers() || tracer_part(radius, bead_mass) > 0; }

double Case::tracer_part(double radius, double bead_mass) const {
  constexpr double kRounding = 1e-4;  // masses and radii of a run are kept in single precision
  const auto alike = [](double a, double b) { return std::fabs(a - b) <= kRounding * b; };
  double tracers = 0, all = 0;
  for (const BeadCase& bead : beads) {
    for (const SizeClass& size : bead.sizes) {
      if (!alike(2 * radius, size.diameter) || !alike(bead_mass, bead.density * sphere_volume(size.diameter))) continue;
      const double part = bead.number_share * size.number_fraction;
      all += part;
      if (bead.tracer) tracers += part;
    }
  }
  return all > 0 ? tracers / all : 0;
}

std::uint64_t bead_count(const Case& c, const std::optional<Vessel>& vessel) {
  const FillCase& fill = c.fill;
  if (fill.count) return *fill.count;
  if (!fill.file.empty()) return fill.placed.size();
  double wanted = 0;
  if (fill.mass) {
    wanted = *fill.mass / c.mean_bead_mass();
  } else {
    const std::optional<Vessel> shell = fill.vessel ? fill.vessel : vessel;
    if (!shell) {
      throw UserError(fill.where,
                      "'fill.filling' has no shell to be counted on; give 'fill.vessel: {diameter, length}' or a mill as geometry");
    }
    const double volume = std::numbers::pi / 4 * shell->diameter * shell->diameter * shell->length;
    wanted = *fill.filling * volume * (1 - fill.porosity) / c.mean_bead_volume();
  }
  const double count = std::round(wanted);
  if (count >= 1 && count <= kLargestCount) return static_cast<std::uint64_t>(count);
  throw UserError(fill.where, fmt::format("'fill' gives {} beads; it must give from 1 to 4e9; check the amount and the bead diameter",
                                          number_text(wanted)));
}

}  // namespace millscope::config
