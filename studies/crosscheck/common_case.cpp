#include "studies/crosscheck/common_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/stl.hpp"

namespace millscope::crosscheck {
namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-6;        // of the period
constexpr double kFrameEvery = 0.02;  // s: about half of the time in which a charge forgets its kinetic energy

/// A node as a file would have it; JSON is also YAML.
config::Node node_of(const nlohmann::json& values, const fs::path& file) { return config::parse_document(values.dump(), file.string()); }

/// Whether a surface reaches from one end of the period along z to the other, and so goes on there.
bool goes_on(const Surface& surface, const config::DomainCase& domain) {
  if (!domain.periodic[2]) return false;
  double low = surface.vertices[2], high = low;
  for (std::uint64_t v = 0; v < surface.vertex_count; ++v)
    low = std::min(low, surface.vertices[3 * v + 2]), high = std::max(high, surface.vertices[3 * v + 2]);
  const double period = domain.box.high[2] - domain.box.low[2];
  return std::fabs(high - low - period) < kSame * period;
}

void put_mesh_in_place(const run::GeometryUse& use, config::PluginInstance& plugin, const config::DomainCase& domain,
                       const fs::path& folder) {
  const fs::path file = fs::absolute(folder / (plugin.name + ".stl")).lexically_normal();
  output::write_stl(file, use.surface, use.slots);
  nlohmann::json values{{"file", file.string()}, {"unit", "m"}};
  if (goes_on(use.surface, domain)) values["period"] = domain.box.high[2] - domain.box.low[2];
  plugin.kind = "mesh";
  plugin.node = node_of(values, folder / "case.yaml");
}

/// Throws where the beads would be put elsewhere than into the geometries of the case.
void require_same_inside(const run::Assembly& given, const run::Assembly& common) {
  for (std::size_t g = 0; g < given.geometries.size(); ++g) {
    const Interior &a = given.geometries[g].interior, &b = common.geometries[g].interior;
    if (a.is_cylinder == 0 || (b.is_cylinder != 0 && std::fabs(a.radius - b.radius) < 0.01 * a.radius)) continue;
    const config::PluginInstance& plugin = given.c.geometry[g].plugin;
    throw base::UserError(
        plugin.where,
        fmt::format("geometry.{}: its triangles do not tell its axis and its radius, as few lifters do not; give three lifters and more",
                    plugin.name));
  }
}

}  // namespace

fs::path write_common_case(const run::Assembly& a, const host::Registry& registry, const fs::path& folder) {
  config::Case c = a.c;
  c.fill.count = a.bead_count;
  c.fill.filling.reset(), c.fill.mass.reset(), c.fill.file.clear();
  for (std::size_t g = 0; g < c.geometry.size(); ++g) {
    if (c.geometry[g].plugin.kind != "mesh") put_mesh_in_place(a.geometries[g], c.geometry[g].plugin, c.domain, folder);
  }
  c.output.series.emplace(), c.output.frames.emplace();
  c.output.frames->every = kFrameEvery, c.output.frames->from = c.time.analyze_from;
  c.output.tracks.reset(), c.output.vtk.reset();
  c.run.engine.clear(), c.run.ranks = 1;
  const fs::path file = folder / "case.yaml";
  output::write_file(file, config::resolved_yaml(c, registry.descriptors()));
  require_same_inside(a, run::assemble(config::read_case(file.string()), registry));
  return file;
}

}  // namespace millscope::crosscheck
