#include "studies/crosscheck/common_case.hpp"

#include <nlohmann/json.hpp>

#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/stl.hpp"

namespace millscope::crosscheck {
namespace {

namespace fs = std::filesystem;

constexpr double kFrameEvery = 0.02;  // s: about half of the time in which a charge forgets its kinetic energy

/// A node as a file would have it; JSON is also YAML.
config::Node node_of(const nlohmann::json& values, const fs::path& file) { return config::parse_document(values.dump(), file.string()); }

void put_mesh_in_place(const run::GeometryUse& use, config::PluginInstance& plugin, double period, const fs::path& folder) {
  const fs::path file = fs::absolute(folder / (plugin.name + ".stl")).lexically_normal();
  output::write_stl(file, use.surface, use.slots);
  plugin.kind = "mesh";
  plugin.node = node_of({{"file", file.string()}, {"unit", "m"}, {"period", period}}, folder / "case.yaml");
}

}  // namespace

fs::path write_common_case(const run::Assembly& a, const host::Registry& registry, const fs::path& folder) {
  config::Case c = a.c;
  c.fill.count = a.bead_count;
  c.fill.filling.reset(), c.fill.mass.reset();
  const double period = c.domain.periodic[2] ? c.domain.box.high[2] - c.domain.box.low[2] : 0;
  for (std::size_t g = 0; g < c.geometry.size(); ++g) {
    if (c.geometry[g].plugin.kind != "mesh") put_mesh_in_place(a.geometries[g], c.geometry[g].plugin, period, folder);
  }
  c.output.series.emplace(), c.output.frames.emplace();
  c.output.frames->every = kFrameEvery, c.output.frames->from = c.time.analyze_from;
  c.output.tracks.reset(), c.output.vtk.reset();
  c.run.engine.clear(), c.run.ranks = 1;
  const fs::path file = folder / "case.yaml";
  output::write_file(file, config::resolved_yaml(c, registry.descriptors()));
  return file;
}

}  // namespace millscope::crosscheck
