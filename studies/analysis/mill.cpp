#include "studies/analysis/mill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kernel/config/case.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/objects.hpp"
#include "kernel/run/bodies.hpp"

namespace millscope::analysis {
namespace {

Interior interior_of(const config::GeometryCase& g, const host::Registry& registry) {
  const host::Loaded& plugin = registry.find(Kind::geometry, g.plugin.kind, g.plugin.where);
  const config::ResolvedValues values = config::resolve(*plugin.descriptor, g.plugin.node, Scope::instance);
  const auto object = host::GeometryObject::create(plugin, values.view(), g.plugin.where);
  Interior interior{};
  object.table().interior(object.self(), &interior);
  return interior;
}

/// The shell: the first turning cylinder, else the first cylinder.
struct Shell {
  std::optional<Interior> interior;
  dem::Motion motion;
};

Shell find_shell(const config::Case& c, const host::Registry& registry) {
  Shell shell;
  for (const config::GeometryCase& g : c.geometry) {
    const Interior interior = interior_of(g, registry);
    if (interior.is_bounded == 0 || interior.is_cylinder == 0) continue;
    const dem::Motion motion = run::motion_of(g.motion, c.walls_ahead());
    if (shell.interior && (shell.motion.speed != 0 || motion.speed == 0)) continue;
    shell = {interior, motion};
  }
  return shell;
}

std::array<double, 3> gravity_of(const config::Case& c, const host::Registry& registry) {
  std::array<double, 3> sum{};
  for (const config::PluginInstance& use : c.body_forces) {
    const host::Loaded* plugin = registry.try_find(Kind::body_force, use.kind);
    if (plugin == nullptr) continue;  // a force of a plugin that is not loaded here is no uniform gravity that an analyzer could use
    const config::ResolvedValues values = config::resolve(*plugin->descriptor, use.node, Scope::instance);
    const auto object = host::BodyForceObject::create(*plugin, values.view(), use.where);
    double g[3];
    if (object.table().uniform(object.self(), 0.0, g) == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += g[k];
  }
  return sum;
}

/// The charge without its tracers, if any are set apart: in a recorded mill there is one of them.
void know_charge(const config::Case& c, const std::optional<config::Vessel>& vessel, AnalyzerContext& context) {
  double mass = 0, volume = 0, share = 0;
  const bool all_tracers = std::all_of(c.beads.begin(), c.beads.end(), [](const config::BeadCase& beads) { return beads.tracer; });
  for (const config::BeadCase& beads : c.beads) {
    if (beads.tracer && !all_tracers) continue;
    share += beads.number_share;
    for (const config::SizeClass& size : beads.sizes)
      context.bead_radius += beads.number_share * size.number_fraction * 0.5 * size.diameter;
    mass += beads.number_share * beads.mean_volume() * beads.density;
    volume += beads.number_share * beads.mean_volume();
  }
  context.bead_density = mass / volume;
  context.bead_radius /= share, mass /= share, volume /= share;
  // A case that serves only as the geometry of a recording may leave the charge open.
  if (!c.fill.count && !c.fill.mass && !c.fill.filling && c.fill.file.empty()) return;
  context.charge_count = static_cast<double>(config::bead_count(c, vessel));
  context.charge_mass = context.charge_count * mass;
  if (!vessel) return;
  // J = V_b/(V_m (1 − φ)) (Chagas 2015, Eq. 3.2)
  const double shell = std::numbers::pi / 4 * vessel->diameter * vessel->diameter * vessel->length;
  context.porosity = c.fill.porosity;
  context.filling = c.fill.filling ? *c.fill.filling : context.charge_count * volume / (shell * (1 - c.fill.porosity));
}

}  // namespace

std::optional<recording::Slice> slice_of(const MillOfCase& mill) {
  if (!(mill.period > 0)) return std::nullopt;
  const double middle = 0.5 * (mill.context.mill_low + mill.context.mill_high);
  return recording::Slice{middle - 0.5 * mill.period, middle + 0.5 * mill.period};
}

MillOfCase read_mill_of_case(const std::filesystem::path& case_file, const host::Registry& registry,
                             const std::vector<std::string>& settings) {
  const config::Case c = config::read_case(case_file.string(), settings);
  MillOfCase mill;
  mill.name = c.name;
  const Shell shell = find_shell(c, registry);
  AnalyzerContext& context = mill.context;
  mill.motion = shell.motion;
  context.omega = shell.motion.speed != 0 ? shell.motion.speed * shell.motion.axis[2] : 0.0;
  std::optional<config::Vessel> vessel;
  if (shell.interior) {
    context.mill_radius = shell.interior->radius;
    context.mill_low = shell.interior->low[2];
    context.mill_high = shell.interior->high[2];
  }
  if (c.domain.periodic[2]) {
    context.is_periodic = 1;
    context.mill_low = c.domain.box.low[2];
    context.mill_high = c.domain.box.high[2];
    mill.period = context.mill_high - context.mill_low;
  }
  context.mill_length = context.mill_high - context.mill_low;
  if (shell.interior) vessel = config::Vessel{2 * context.mill_radius, context.mill_length};
  know_charge(c, vessel, context);
  const std::array<double, 3> g = gravity_of(c, registry);
  context.gravity = -g[1];
  mill.upright = g[1] < 0 && std::hypot(g[0], g[2]) <= 1e-9 * std::fabs(g[1]);
  if (!mill.upright) {
    mill.notes.push_back(fmt::format("gravity is ({:.4g}, {:.4g}, {:.4g}) m/s^2: the analyzers use its part along -y, {:.4g} m/s^2", g[0],
                                     g[1], g[2], context.gravity));
  }
  return mill;
}

}  // namespace millscope::analysis
