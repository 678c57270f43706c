#include "kernel/run/assembly.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "kernel/config/values.hpp"
#include "kernel/run/bodies.hpp"

namespace millscope::run {
namespace {

using base::UserError;

int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

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

struct BeadRange {
  double smallest_radius = 1e300, largest_radius = 0, smallest_density = 1e300, largest_density = 0;
};

BeadRange range_of(const config::Case& c, const std::string& material) {
  BeadRange r;
  for (const config::BeadCase& b : c.beads) {
    if (b.material != material) continue;
    r.smallest_density = std::min(r.smallest_density, b.density);
    r.largest_density = std::max(r.largest_density, b.density);
    for (const config::SizeClass& s : b.sizes) {
      r.smallest_radius = std::min(r.smallest_radius, 0.5 * s.diameter);
      r.largest_radius = std::max(r.largest_radius, 0.5 * s.diameter);
    }
  }
  return r;
}

double sphere_mass(double radius, double density) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density; }

PairContext context_of(const Assembly& a, int first, int second, bool wall) {
  const auto material = [&a](int index) {
    const config::MaterialCase& m = a.c.material(a.materials[static_cast<std::size_t>(index)]);
    return Material{m.name.c_str(), m.density, a.c.softened_young(m), m.poisson};
  };
  PairContext p{};
  p.first = material(first);
  p.second = material(second);
  const auto shear = [](const Material& m) { return m.young / (2 * (1 + m.poisson)); };
  p.effective_young =
      1 / ((1 - p.first.poisson * p.first.poisson) / p.first.young + (1 - p.second.poisson * p.second.poisson) / p.second.young);
  p.effective_shear = 1 / ((2 - p.first.poisson) / shear(p.first) + (2 - p.second.poisson) / shear(p.second));
  const BeadRange i = range_of(a.c, p.first.name), j = range_of(a.c, p.second.name);
  const auto reduced = [wall](double x, double y) { return wall ? x : x * y / (x + y); };
  p.smallest_radius = reduced(i.smallest_radius, j.smallest_radius);
  p.largest_radius = reduced(i.largest_radius, j.largest_radius);
  p.smallest_mass = reduced(sphere_mass(i.smallest_radius, i.smallest_density), sphere_mass(j.smallest_radius, j.smallest_density));
  p.largest_mass = reduced(sphere_mass(i.largest_radius, i.largest_density), sphere_mass(j.largest_radius, j.largest_density));
  p.typical_speed = a.typical_speed;
  p.with_wall = wall ? 1 : 0;
  return p;
}

/// How long the smallest beads of a pair touch at that closing speed, s: what the law says, else Hertz's, undamped:
/// 2.87 (m*²/(R* E*² v))^{1/5} (Johnson 1985, eq. 11.24).
double contact_time(const dem::LawReference& law, const PairContext& p, double speed) {
  const double said = law.table->contact_time(law.self, p.smallest_radius, p.smallest_mass, speed);
  if (said > 0) return said;
  const double young = p.effective_young;
  return 2.87 * std::pow(p.smallest_mass * p.smallest_mass / (p.smallest_radius * young * young * speed), 0.2);
}

struct Channels {
  std::vector<std::string> names;
  std::vector<int> signs;
  void add(const std::string& plugin, const ContactLawInfo& info) {
    for (std::uint32_t k = 0; k < info.channel_count; ++k) names.push_back(plugin + "." + info.channel_name[k]);
    for (std::uint32_t k = 0; k < info.history_count; ++k) signs.push_back(info.history_sign[k]);
  }
};

/// Creates law, interactions and pair parameters of one pair of materials.
dem::PairPhysics make_pair(Assembly& a, const host::Registry& registry, int first, int second, bool wall) {
  dem::PairPhysics p;
  p.first = first;
  p.second = second;
  p.wall = wall;
  const std::string &n1 = a.materials[static_cast<std::size_t>(first)], &n2 = a.materials[static_cast<std::size_t>(second)];
  p.name = n1 + "~" + n2 + (wall ? " (wall)" : "");
  const config::Node section = a.c.pairs.lookup(n1, n2);
  const PairContext context = context_of(a, first, second, wall);
  const auto create = [&]<class Object>(Object*, Kind kind, const config::PluginInstance& use) {
    const host::Loaded& plugin = registry.find(kind, use.kind, use.where);
    const config::ResolvedValues values = config::resolve_for_pair(*plugin.descriptor, use.node, section);
    return Object::create(plugin, values.view(), section.where(), context);
  };
  a.laws.push_back(create(static_cast<host::LawObject*>(nullptr), Kind::contact_law, a.c.contact.law));
  const host::LawObject& law = a.laws.back();
  p.law = {&law.table(), law.self()};
  p.reach = law.table().reach(law.self(), context.largest_radius);
  for (const config::PluginInstance& use : a.c.contact.interactions) {
    a.interactions.push_back(create(static_cast<host::InteractionObject*>(nullptr), Kind::interaction, use));
    const host::InteractionObject& i = a.interactions.back();
    p.interactions.push_back({&i.table(), i.self(), host::acts_before(i), use.name});
    p.reach = std::max(p.reach, i.table().reach(i.self(), context.largest_radius));
  }
  for (const config::PluginInstance& use : a.c.contact.pair_parameters) {
    a.pair_parameters.push_back(create(static_cast<host::PairParameterObject*>(nullptr), Kind::pair_parameter, use));
    const host::PairParameterObject& i = a.pair_parameters.back();
    const std::uint64_t features = i.plugin().descriptor->features;
    p.pair_parameters.push_back({&i.table(), i.self(), (features & kGivesRestitution) != 0, (features & kGivesFriction) != 0});
  }
  const double time = contact_time(p.law, context, a.typical_speed);
  a.hertz_contact_time = a.hertz_contact_time > 0 ? std::min(a.hertz_contact_time, time) : time;
  return p;
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

}  // namespace

// Rayleigh wave over half the circumference of a bead (Thornton & Randall 1988).
double rayleigh_time(double radius, double density, double young, double poisson) {
  const double shear = young / (2 * (1 + poisson));
  return std::numbers::pi * radius * std::sqrt(density / shear) / (0.1631 * poisson + 0.8766);
}

int Assembly::wall_body_of_mill() const {
  for (std::size_t g = 0; g < c.geometry.size(); ++g) {
    if (c.geometry[g].motion.rotation && c.geometry[g].motion.rotation->speed != 0) return static_cast<int>(g);
  }
  return -1;
}

Assembly assemble(config::Case c, const host::Registry& registry, const AssemblyOptions& options) {
  Assembly a;
  a.c = std::move(c);
  a.geometries = make_geometries(a.c, registry);
  a.materials = material_order(a.c, a.geometries);
  a.mill_speed = a.c.mill ? a.c.mill->speed : 0.0;
  const int body = a.wall_body_of_mill();
  if (!a.c.mill && body >= 0) a.mill_speed = a.c.geometry[static_cast<std::size_t>(body)].motion.rotation->speed;
  a.typical_speed = typical_speed(a);

  a.rayleigh_time = 1e300;
  for (const config::BeadCase& b : a.c.beads) {
    const config::MaterialCase& m = a.c.material(b.material);
    for (const config::SizeClass& s : b.sizes) {
      a.rayleigh_time = std::min(a.rayleigh_time, rayleigh_time(0.5 * s.diameter, b.density, a.c.softened_young(m), m.poisson));
    }
  }
  a.time_step = a.c.time.step ? *a.c.time.step : a.c.time.step_fraction * a.rayleigh_time;

  // Pairs: every two bead materials, and every bead material with every wall material.
  const int materials = static_cast<int>(a.materials.size());
  std::vector<bool> is_bead(a.materials.size()), is_wall(a.materials.size());
  for (const config::BeadCase& b : a.c.beads) is_bead[static_cast<std::size_t>(index_of(a.materials, b.material))] = true;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    for (const std::string& slot : a.geometries[g].slots)
      is_wall[static_cast<std::size_t>(index_of(a.materials, a.c.geometry[g].material_of(slot)))] = true;
  }
  std::vector<dem::PairPhysics> pairs;
  for (int i = 0; i < materials; ++i) {
    for (int j = 0; j < materials; ++j) {
      const std::size_t si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
      if (is_bead[si] && is_bead[sj] && i <= j) pairs.push_back(make_pair(a, registry, i, j, false));
      if (is_bead[si] && is_wall[sj]) pairs.push_back(make_pair(a, registry, i, j, true));
    }
  }
  for (const config::PluginInstance& use : a.c.body_forces) {
    const host::Loaded& plugin = registry.find(Kind::body_force, use.kind, use.where);
    const config::ResolvedValues values = config::resolve(*plugin.descriptor, use.node, Scope::instance);
    a.body_forces.push_back(host::BodyForceObject::create(plugin, values.view(), use.where));
  }
  config::finish(a.c, registry.descriptors());
  check_time_step(a);

  Channels layout;
  layout.add(a.c.contact.law.kind, pairs.front().law.table->info);
  for (const dem::InteractionReference& i : pairs.front().interactions) layout.add(i.name, i.table->info);
  for (const dem::PairParameterReference& p : pairs.front().pair_parameters) layout.add("", p.table->info);

  if (layout.signs.size() > static_cast<std::size_t>(dem::kMaxHistories)) {
    throw UserError(a.c.contact.law.where,
                    fmt::format("law, interactions and pair parameters keep {} numbers per contact together; at most {} are possible: "
                                "leave one of them out",
                                layout.signs.size(), dem::kMaxHistories));
  }
  dem::Settings s;
  s.time_step = a.time_step;
  s.partitions = a.c.run.partitions;
  s.threads = options.threads > 0   ? options.threads
              : a.c.run.threads > 0 ? a.c.run.threads
                                    : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  s.instruction_set = options.instruction_set.empty() ? host::text(registry.instruction_set()) : options.instruction_set;
  // run.skin scales how long a list may last: 0.2 d is the reference.
  s.skin_steps *= a.c.run.skin / 0.2;
  set_domain(a, s);
  a.system = std::make_unique<dem::System>(s, dem::Layout{layout.names, layout.signs}, std::move(pairs), materials);
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    dem::Body body_use;
    body_use.name = a.c.geometry[g].plugin.name;
    body_use.table = &a.geometries[g].object.table();
    body_use.self = a.geometries[g].object.self();
    body_use.motion = motion_of(a.c.geometry[g].motion);
    for (const std::string& slot : a.geometries[g].slots)
      body_use.material_of_slot.push_back(index_of(a.materials, a.c.geometry[g].material_of(slot)));
    body_use.greatest_distance = greatest_distance(a.geometries[g].surface, body_use.motion);
    body_use.triangle_count = a.geometries[g].surface.triangle_count;
    body_use.per_triangle = a.c.output.vtk.has_value();
    a.system->bodies.push_back(std::move(body_use));
  }
  for (std::size_t f = 0; f < a.body_forces.size(); ++f) {
    const host::BodyForceObject& force = a.body_forces[f];
    a.system->body_forces.push_back({&force.table(), force.self(), a.c.body_forces[f].name});
    double g[3];
    if (force.table().uniform(force.self(), 0.0, g)) {
      for (std::size_t k = 0; k < 3; ++k) a.gravity[k] += g[k];
    }
  }
  a.settle_steps = static_cast<std::int64_t>(std::ceil(a.c.fill.settle / a.time_step));
  a.end_step = static_cast<std::int64_t>(std::ceil(a.c.time.end / a.time_step));
  a.analyze_step = static_cast<std::int64_t>(std::ceil(a.c.time.analyze_from / a.time_step));
  std::optional<config::Vessel> vessel;
  for (std::size_t g = 0; g < a.geometries.size() && !vessel; ++g) {
    const Interior& in = a.geometries[g].interior;
    if (!in.is_bounded || !in.is_cylinder) continue;
    const double length = s.periodic.length[2] > 0 ? s.periodic.length[2] : in.high[2] - in.low[2];
    vessel = config::Vessel{2 * in.radius, length};
  }
  a.bead_count = config::bead_count(a.c, vessel);
  return a;
}

double shortest_contact(const Assembly& a, double speed) {
  double shortest = 1e300;
  for (const dem::PairPhysics& p : a.system->physics()) {
    shortest = std::min(shortest, contact_time(p.law, context_of(a, p.first, p.second, p.wall), speed));
  }
  return shortest;
}

void begin(Assembly& a) { a.system->start(-a.settle_steps); }

}  // namespace millscope::run
