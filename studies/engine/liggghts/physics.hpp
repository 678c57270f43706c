// The physics of a case as the properties of LIGGGHTS' atom types: type k + 1 is material k.
#pragma once

#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::engine::liggghts {

/// A property of each pair of types, row by row; pairs that never meet have `kNeverUsed`.
struct PairProperty {
  std::string name;
  std::vector<double> values;
};
inline constexpr double kNeverUsed = 0.5;

struct Physics {
  std::vector<double> young, poisson;  ///< Pa (softened) and 1, of each type
  std::vector<PairProperty> pairs;
  std::string model;     ///< the words behind `gran model`, for beads and walls, in the order that LIGGGHTS wants
  std::string settings;  ///< behind all other words
};

/// Throws base::UserError where a coefficient is missing. The case has no obstacles (obstacles.hpp).
Physics physics_of(const run::Assembly& a, const host::Registry& registry);

/// A coefficient of `pairs` that a contact law takes.
double pair_number(const run::Assembly& a, const host::Registry& registry, const config::PluginInstance& law, const dem::PairPhysics& pair,
                   const char* parameter);

/// A number of an interaction or a law, by its instance alone.
double instance_number(const config::PluginInstance& use, Kind kind, const char* parameter, const host::Registry& registry);
std::string instance_text(const config::PluginInstance& use, Kind kind, const char* parameter, const host::Registry& registry);

}  // namespace millscope::engine::liggghts
