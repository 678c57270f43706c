#include "kernel/run/assembly.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <thread>

#include "kernel/config/imported.hpp"
#include "kernel/config/values.hpp"
#include "kernel/run/bodies.hpp"
#include "kernel/run/pair_physics.hpp"

namespace millscope::run {
namespace {

using base::UserError;

/// Materials in the order: those of beads, then those of walls.
std::vector<std::string> material_order(const config::Case& c, const std::vector<GeometryUse>& geometries) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const config::BeadCase& b : c.beads) add(b.material);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    for (const std::string& slot : geometries[g].slots) add(c.geometry[g].material_of(slot));
  }
  return names;
}

/// A closing speed to expect: a bead that falls through the mill and meets the rising shell.
double typical_speed(const Assembly& a) {
  double height = 0.1, wall = 0;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const Interior& in = a.geometries[g].interior;
    if (in.is_bounded) height = std::max(height, in.is_cylinder ? 2 * in.radius : in.high[1] - in.low[1]);
    if (in.is_bounded && in.is_cylinder && a.c.geometry[g].motion.rotation) {
      wall = std::max(wall, std::abs(a.c.geometry[g].motion.rotation->speed) * in.radius);
    }
  }
  return std::sqrt(2 * 9.81 * height) + wall;
}

void check_time_step(const Assembly& a) {
  const double fraction = a.time_step / a.rayleigh_time;
  const double longest = std::max(a.c.time.end, a.c.fill.settle);
  if (!(longest / a.time_step < kMostSteps)) {
    throw UserError(a.c.time.where, fmt::format("{:.4g} s in steps of {:.4g} s are more than {:.0e} steps: no run ends; check time.end_s, "
                                                "fill.settle_s and time.step_s",
                                                longest, a.time_step, kMostSteps));
  }
  if (a.c.run.allow_unstable) return;
  if (fraction > 0.6) {
    throw UserError(a.c.time.where,
                    fmt::format("the time step {:.4g} s is {:.0f} % of the Rayleigh time {:.4g} s; above 60 % explicit integration is "
                                "unstable; lower time.step_s or time.step_fraction (20 % is usual), or set run.allow_unstable: true",
                                a.time_step, 100 * fraction, a.rayleigh_time));
  }
  if (a.hertz_contact_time > 0 && a.time_step > a.hertz_contact_time / 10) {
    throw UserError(a.c.time.where,
                    fmt::format("the time step {:.4g} s resolves a contact of {:.4g} s at {:.3g} m/s with fewer than 10 steps; lower "
                                "time.step_fraction, or set run.allow_unstable: true",
                                a.time_step, a.hertz_contact_time, a.typical_speed));
  }
}

/// The box that no bead may leave: what the user gave, else the bounds of the bodies on their way, with a margin of a bead. A plane has
/// no end and bounds nothing.
void set_domain(const Assembly& a, dem::Settings& s) {
  config::Box bounds;
  bounds.low.fill(1e300);
  bounds.high.fill(-1e300);
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    if (!a.geometries[g].interior.is_bounded) continue;
    const config::Box box = swept(a.geometries[g].surface, motion_of(a.c.geometry[g].motion), a.c.time.end);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.low[axis] = std::min(bounds.low[axis], box.low[axis]);
      bounds.high[axis] = std::max(bounds.high[axis], box.high[axis]);
    }
  }
  const double margin = a.c.largest_diameter();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // An open floor does not bound what is put above it.
    if (a.c.fill.region && bounds.low[axis] <= bounds.high[axis]) {
      bounds.low[axis] = std::min(bounds.low[axis], a.c.fill.region->low[axis]);
      bounds.high[axis] = std::max(bounds.high[axis], a.c.fill.region->high[axis]);
    }
    const double low = bounds.low[axis], high = bounds.high[axis];
    const double user_low = a.c.domain.box.low[axis], user_high = a.c.domain.box.high[axis];
    s.low[axis] = std::isfinite(user_low) ? user_low : low <= high ? low - margin : -1e3;
    s.high[axis] = std::isfinite(user_high) ? user_high : low <= high ? high + margin : 1e3;
    if (a.c.domain.periodic[axis]) {
      s.periodic.length[axis] = user_high - user_low;
      s.periodic_low[axis] = user_low;
    }
  }
}

double mill_speed(const Assembly& a) {
  if (a.c.mill) return a.c.mill->speed;
  const std::optional<int> body = a.wall_body_of_mill();
  return body ? a.c.geometry[*body].motion.rotation->speed : 0.0;
}

double shortest_rayleigh_time(const config::Case& c) {
  double shortest = 1e300;
  for (const config::BeadCase& b : c.beads) {
    const config::MaterialCase& m = c.material(b.material);
    for (const config::SizeClass& s : b.sizes)
      shortest = std::min(shortest, rayleigh_time(0.5 * s.diameter, b.density, c.softened_young(m), m.poisson));
  }
  return shortest;
}

void make_body_forces(Assembly& a, const host::Registry& registry) {
  for (const config::PluginInstance& use : a.c.body_forces) {
    const host::Loaded& plugin = registry.find(Kind::body_force, use.kind, use.where);
    const config::ResolvedValues values = config::resolve(*plugin.descriptor, use.node, Scope::instance);
    a.body_forces.push_back(host::BodyForceObject::create(plugin, values.view(), use.where));
  }
}

/// The first cylinder that holds beads, as long as the domain repeats.
std::optional<config::Vessel> vessel_of(const Assembly& a, double period) {
  for (const GeometryUse& use : a.geometries) {
    const Interior& in = use.interior;
    if (!in.is_bounded || !in.is_cylinder) continue;
    return config::Vessel{2 * in.radius, period > 0 ? period : in.high[2] - in.low[2]};
  }
  return {};
}

/// Steps until a time, the last one whole.
std::int64_t steps_until(double time, double time_step) { return static_cast<std::int64_t>(std::ceil(time / time_step)); }

/// And the number of beads, which that of the slabs follows from.
dem::Settings settings_of(Assembly& a, const host::Registry& registry, const AssemblyOptions& options) {
  dem::Settings s;
  s.time_step = a.time_step;
  s.threads = options.threads > 0   ? options.threads
              : a.c.run.threads > 0 ? a.c.run.threads
                                    : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  s.instruction_set = options.instruction_set.empty() ? host::text(registry.instruction_set()) : options.instruction_set;
  // run.skin scales how long a list may last: 0.2 d is the reference.
  s.skin_steps *= a.c.run.skin / 0.2;
  set_domain(a, s);
  a.bead_count = config::bead_count(a.c, vessel_of(a, s.periodic.length[2]));
  if (a.c.run.partitions == 0) a.c.run.partitions = dem::partitions_for(a.bead_count);
  s.partitions = a.c.run.partitions;
  s.wear_from_step = steps_until(a.c.time.analyze_from, a.time_step);
  return s;
}

void add_bodies(Assembly& a) {
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const GeometryUse& use = a.geometries[g];
    dem::Body body;
    body.name = a.c.geometry[g].plugin.name;
    body.table = &use.object.table();
    body.self = use.object.self();
    body.motion = motion_of(a.c.geometry[g].motion, a.c.walls_ahead());
    for (const std::string& slot : use.slots) body.material_of_slot.push_back(a.index_of_material(a.c.geometry[g].material_of(slot)));
    body.greatest_distance = greatest_distance(use.surface, body.motion);
    body.triangle_count = use.surface.triangle_count;
    body.per_triangle = a.c.output.vtk.has_value() || !a.c.contact.wear.empty();
    a.system->bodies.push_back(std::move(body));
  }
}

/// Hands the body forces to the system and adds up what is uniform of them.
void add_body_forces(Assembly& a) {
  for (std::size_t f = 0; f < a.body_forces.size(); ++f) {
    const host::BodyForceObject& force = a.body_forces[f];
    a.system->body_forces.push_back({&force.table(), force.self(), a.c.body_forces[f].name});
    double g[3];
    if (force.table().uniform(force.self(), 0.0, g)) {
      for (std::size_t k = 0; k < 3; ++k) a.gravity[k] += g[k];
    }
  }
}

}  // namespace

// Rayleigh wave over half the circumference of a bead (Thornton & Randall 1988).
double rayleigh_time(double radius, double density, double young, double poisson) {
  const double shear = young / (2 * (1 + poisson));
  return std::numbers::pi * radius * std::sqrt(density / shear) / (0.1631 * poisson + 0.8766);
}

std::int64_t steps_of(double interval, double time_step) {
  return std::max<std::int64_t>(1, std::llround(std::min(interval / time_step, kMostSteps)));
}

int Assembly::index_of_material(const std::string& name) const {
  const auto found = std::find(materials.begin(), materials.end(), name);
  assert(found != materials.end());
  return static_cast<int>(found - materials.begin());
}

std::optional<int> Assembly::wall_body_of_mill() const {
  for (std::size_t g = 0; g < c.geometry.size(); ++g) {
    if (c.geometry[g].motion.rotation && c.geometry[g].motion.rotation->speed != 0) return static_cast<int>(g);
  }
  return std::nullopt;
}

Assembly assemble(config::Case c, const host::Registry& registry, const AssemblyOptions& options) {
  config::refuse_imported(c);
  Assembly a;
  a.c = std::move(c);
  a.geometries = make_geometries(a.c, registry);
  a.materials = material_order(a.c, a.geometries);
  a.mill_speed = mill_speed(a);
  a.typical_speed = typical_speed(a);
  a.rayleigh_time = shortest_rayleigh_time(a.c);
  a.time_step = a.c.time.step ? *a.c.time.step : a.c.time.step_fraction * a.rayleigh_time;
  std::vector<dem::PairPhysics> pairs = make_pairs(a, registry);
  make_body_forces(a, registry);
  config::finish(a.c, registry.descriptors());
  check_time_step(a);
  const dem::Layout layout = contact_layout(a, pairs.front());
  a.system =
      std::make_unique<dem::System>(settings_of(a, registry, options), layout, std::move(pairs), static_cast<int>(a.materials.size()));
  add_bodies(a);
  add_body_forces(a);
  a.first_step =
      a.c.start ? steps_until(a.c.time.analyze_from - a.c.start->develop, a.time_step) : -steps_until(a.c.fill.settle, a.time_step);
  a.end_step = steps_until(a.c.time.end, a.time_step);
  a.analyze_step = steps_until(a.c.time.analyze_from, a.time_step);
  return a;
}

void begin(Assembly& a) { a.system->start(a.first_step); }

}  // namespace millscope::run
