#include "kernel/run/pair_physics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "kernel/config/values.hpp"

namespace millscope::run {
namespace {

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
    const config::MaterialCase& m = a.c.material(a.materials[index]);
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

/// With both materials so many times as stiff.
PairContext stiffer(PairContext p, double factor) {
  for (double* young : {&p.first.young, &p.second.young, &p.effective_young, &p.effective_shear}) *young *= factor;
  return p;
}

/// Whether a pair's contacts last shorter by the second law than by the first, as both say; false where they say nothing.
bool gets_shorter(const host::LawObject& law, const host::LawObject& stiffer_law, const PairContext& p) {
  constexpr double kSpeed = 1;  // m/s; any
  const auto time = [&](const host::LawObject& l) { return l.table().contact_time(l.self(), p.smallest_radius, p.smallest_mass, kSpeed); };
  return time(stiffer_law) < time(law);
}

/// Creates law, interactions and pair parameters of one pair of materials.
dem::PairPhysics make_pair(Assembly& a, const host::Registry& registry, int first, int second, bool wall) {
  dem::PairPhysics p;
  p.first = first;
  p.second = second;
  p.wall = wall;
  const std::string &n1 = a.materials[first], &n2 = a.materials[second];
  p.name = n1 + "~" + n2 + (wall ? " (wall)" : "");
  const config::Node section = a.c.pairs.lookup(n1, n2);
  const PairContext context = context_of(a, first, second, wall);
  const auto create = [&]<class Object>(Object*, Kind kind, const config::PluginInstance& use, const PairContext& between) {
    const host::Loaded& plugin = registry.find(kind, use.kind, use.where);
    const config::ResolvedValues values = config::resolve_for_pair(*plugin.descriptor, use.node, section);
    return Object::create(plugin, values.view(), section.where(), between);
  };
  const auto law_between = [&](const PairContext& between) {
    return create(static_cast<host::LawObject*>(nullptr), Kind::contact_law, a.c.contact.law, between);
  };
  a.laws.push_back(law_between(context));
  const host::LawObject& law = a.laws.back();
  p.law = {&law.table(), law.self()};
  p.reach = law.table().reach(law.self(), context.largest_radius);
  for (const config::PluginInstance& use : a.c.contact.interactions) {
    a.interactions.push_back(create(static_cast<host::InteractionObject*>(nullptr), Kind::interaction, use, context));
    const host::InteractionObject& i = a.interactions.back();
    p.interactions.push_back({&i.table(), i.self(), host::acts_before(i), use.name});
    p.reach = std::max(p.reach, i.table().reach(i.self(), context.largest_radius));
  }
  for (const config::PluginInstance& use : a.c.contact.pair_parameters) {
    a.pair_parameters.push_back(create(static_cast<host::PairParameterObject*>(nullptr), Kind::pair_parameter, use, context));
    const host::PairParameterObject& i = a.pair_parameters.back();
    const std::uint64_t features = i.plugin().descriptor->features;
    p.pair_parameters.push_back({&i.table(), i.self(), (features & kGivesRestitution) != 0, (features & kGivesFriction) != 0});
  }
  for (const config::PluginInstance& use : wall ? a.c.contact.wear : std::vector<config::PluginInstance>{}) {
    a.wear_laws.push_back(create(static_cast<host::WearLawObject*>(nullptr), Kind::wear_law, use, context));
    p.wear.push_back({&a.wear_laws.back().table(), a.wear_laws.back().self(), use.name});
  }
  const double time = contact_time(p.law, context, a.typical_speed);
  a.stiffness_from_young &= gets_shorter(law, law_between(stiffer(context, 2)), context);
  a.hertz_contact_time = a.hertz_contact_time > 0 ? std::min(a.hertz_contact_time, time) : time;
  return p;
}

/// Which materials beads are made of, and which walls.
struct MaterialUse {
  std::vector<bool> of_beads, of_walls;
};

MaterialUse use_of_materials(const Assembly& a) {
  MaterialUse use{std::vector<bool>(a.materials.size()), std::vector<bool>(a.materials.size())};
  for (const config::BeadCase& b : a.c.beads) use.of_beads[a.index_of_material(b.material)] = true;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    for (const std::string& slot : a.geometries[g].slots) use.of_walls[a.index_of_material(a.c.geometry[g].material_of(slot))] = true;
  }
  return use;
}

}  // namespace

std::vector<dem::PairPhysics> make_pairs(Assembly& a, const host::Registry& registry) {
  const MaterialUse use = use_of_materials(a);
  std::vector<dem::PairPhysics> pairs;
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    for (std::size_t j = 0; j < a.materials.size(); ++j) {
      const int first = static_cast<int>(i), second = static_cast<int>(j);
      if (use.of_beads[i] && use.of_beads[j] && i <= j) pairs.push_back(make_pair(a, registry, first, second, false));
      if (use.of_beads[i] && use.of_walls[j]) pairs.push_back(make_pair(a, registry, first, second, true));
    }
  }
  return pairs;
}

dem::Layout contact_layout(const Assembly& a, const dem::PairPhysics& pair) {
  dem::Layout layout;
  const auto add_histories = [&layout](const auto& info) {
    for (std::uint32_t h = 0; h < info.history_count; ++h) layout.history_sign.push_back(info.histories[h].sign);
  };
  const auto add = [&](const std::string& plugin, const PairTermInfo& info) {
    for (std::uint32_t k = 0; k < info.channel_count; ++k) layout.channels.push_back(plugin + "." + info.channels[k].name);
    add_histories(info);
  };
  add(a.c.contact.law.kind, pair.law.table->info);
  for (const dem::InteractionReference& i : pair.interactions) add(i.name, i.table->info);
  for (const dem::PairParameterReference& p : pair.pair_parameters) add_histories(p.table->info);
  if (layout.history_sign.size() > static_cast<std::size_t>(dem::kMaxHistories)) {
    throw base::UserError(
        a.c.contact.law.where,
        fmt::format("law, interactions and pair parameters keep {} numbers per contact together; at most {} are possible: "
                    "leave one of them out",
                    layout.history_sign.size(), dem::kMaxHistories));
  }
  return layout;
}

double shortest_contact(const Assembly& a, double speed) {
  double shortest = 1e300;
  for (const dem::PairPhysics& p : a.system->physics()) {
    shortest = std::min(shortest, contact_time(p.law, context_of(a, p.first, p.second, p.wall), speed));
  }
  return shortest;
}

}  // namespace millscope::run
