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

/// Of each pair of materials that can meet; the table is symmetric.
PairProperty property(const run::Assembly& a, const host::Registry& registry, const char* name, const Source& source,
                      const char* parameter) {
  const std::size_t n = a.materials.size();
  PairProperty table{name, std::vector<double>(n * n, kNeverUsed)};
  const Descriptor& plugin = *registry.find(source.kind, source.use.kind, source.use.where).descriptor;
  for (const dem::PairPhysics& pair : a.system->physics()) {
    const auto i = static_cast<std::size_t>(pair.first), j = static_cast<std::size_t>(pair.second);
    const config::Node values_of_pair = a.c.pairs.lookup(a.materials[i], a.materials[j]);
    const config::ResolvedValues values = config::resolve_for_pair(plugin, source.use.node, values_of_pair);
    table.values[i * n + j] = table.values[j * n + i] = Parameters(values.view()).number(parameter);
  }
  return table;
}

PairProperty same_for_all(const run::Assembly& a, const char* name, double value) {
  return {name, std::vector<double>(a.materials.size() * a.materials.size(), value)};
}

void add_rolling(const run::Assembly& a, const host::Registry& registry, const config::PluginInstance& use, Physics& physics) {
  physics.pairs.push_back(property(a, registry, "coefficientRollingFriction", {use, Kind::interaction}, "rolling_friction"));
  if (use.kind != "rolling_epsd") {
    physics.model += " rolling_friction cdt";
    return;
  }
  physics.model += " rolling_friction epsd";
  physics.pairs.push_back(
      same_for_all(a, "coefficientRollingViscousDamping", instance_number(use, Kind::interaction, "damping_ratio", registry)));
}

}  // namespace

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
  for (const config::PluginInstance& use : a.c.contact.interactions) {
    if (use.kind == "cohesion_sjkr") {
      physics.model += " cohesion sjkr";
      physics.pairs.push_back(property(a, registry, "cohesionEnergyDensity", {use, Kind::interaction}, "cohesion_energy_density"));
    } else {
      add_rolling(a, registry, use, physics);
    }
  }
  if (instance_number(law, Kind::contact_law, "allow_tension", registry) == 0) physics.model += " limitForce on";
  return physics;
}

}  // namespace millscope::engine::liggghts
