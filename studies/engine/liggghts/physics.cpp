#include "studies/engine/liggghts/physics.hpp"

#include "kernel/config/values.hpp"
#include "millscope/parameters.hpp"

namespace millscope::engine::liggghts {
namespace {

/// Where a coefficient of `pairs` comes from.
struct Source {
  const config::PluginInstance& use;
  Kind kind;
};

double number_of_pair(const run::Assembly& a, const host::Registry& registry, const Source& source, const dem::PairPhysics& pair,
                      const char* parameter) {
  const Descriptor& plugin = *registry.find(source.kind, source.use.kind, source.use.where).descriptor;
  const config::Node node =
      a.c.pairs.lookup(a.materials[static_cast<std::size_t>(pair.first)], a.materials[static_cast<std::size_t>(pair.second)]);
  const config::ResolvedValues values = config::resolve_for_pair(plugin, source.use.node, node);
  return Parameters(values.view()).number(parameter);
}

/// Of each pair of materials that can meet; the table is symmetric.
PairProperty property(const run::Assembly& a, const host::Registry& registry, const char* name, const Source& source,
                      const char* parameter) {
  const std::size_t n = a.materials.size();
  PairProperty table{name, std::vector<double>(n * n, kNeverUsed)};
  for (const dem::PairPhysics& pair : a.system->physics()) {
    const auto i = static_cast<std::size_t>(pair.first), j = static_cast<std::size_t>(pair.second);
    table.values[i * n + j] = table.values[j * n + i] = number_of_pair(a, registry, source, pair, parameter);
  }
  return table;
}

void add_rolling(const run::Assembly& a, const host::Registry& registry, const config::PluginInstance& use, Physics& physics) {
  physics.pairs.push_back(property(a, registry, "coefficientRollingFriction", {use, Kind::interaction}, "rolling_friction"));
  if (use.kind != "rolling_epsd") {
    physics.model += " rolling_friction cdt";
    return;
  }
  physics.model += " rolling_friction epsd";
  const double damping = instance_number(use, Kind::interaction, "damping_ratio", registry);
  const std::size_t n = a.materials.size();
  physics.pairs.push_back({"coefficientRollingViscousDamping", std::vector<double>(n * n, damping)});
}

void add_cohesion(const run::Assembly& a, const host::Registry& registry, const config::PluginInstance& use, Physics& physics) {
  physics.pairs.push_back(property(a, registry, "cohesionEnergyDensity", {use, Kind::interaction}, "cohesion_energy_density"));
  physics.model += " cohesion sjkr";
}

}  // namespace

double pair_number(const run::Assembly& a, const host::Registry& registry, const config::PluginInstance& law, const dem::PairPhysics& pair,
                   const char* parameter) {
  return number_of_pair(a, registry, {law, Kind::contact_law}, pair, parameter);
}

double instance_number(const config::PluginInstance& use, Kind kind, const char* parameter, const host::Registry& registry) {
  const config::ResolvedValues values = config::resolve(*registry.find(kind, use.kind, use.where).descriptor, use.node, Scope::instance);
  return Parameters(values.view()).number(parameter);
}

std::string instance_text(const config::PluginInstance& use, Kind kind, const char* parameter, const host::Registry& registry) {
  const config::ResolvedValues values = config::resolve(*registry.find(kind, use.kind, use.where).descriptor, use.node, Scope::instance);
  return Parameters(values.view()).text(parameter);
}

Physics physics_of(const run::Assembly& a, const host::Registry& registry) {
  Physics physics;
  for (const std::string& name : a.materials) {
    const config::MaterialCase& material = a.c.material(name);
    physics.young.push_back(a.c.softened_young(material));
    physics.poisson.push_back(material.poisson);
  }
  const config::PluginInstance& law = a.c.contact.law;
  physics.pairs.push_back(property(a, registry, "coefficientRestitution", {law, Kind::contact_law}, "restitution"));
  physics.pairs.push_back(property(a, registry, "coefficientFriction", {law, Kind::contact_law}, "static_friction"));
  physics.model = "hertz tangential history";
  const auto each = [&](bool cohesion, const auto& add) {
    for (const config::PluginInstance& use : a.c.contact.interactions) {
      if ((use.kind == "cohesion_sjkr") == cohesion) add(a, registry, use, physics);
    }
  };
  each(true, add_cohesion);
  each(false, add_rolling);
  if (instance_number(law, Kind::contact_law, "allow_tension", registry) == 0) physics.settings = " limitForce on";
  return physics;
}

}  // namespace millscope::engine::liggghts
