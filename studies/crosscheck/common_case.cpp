#include "studies/crosscheck/common_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/run/derived_case.hpp"

namespace millscope::crosscheck {
namespace {

namespace fs = std::filesystem;

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
  run::fill_by_count(c, a.bead_count);
  for (std::size_t g = 0; g < c.geometry.size(); ++g) {
    if (c.geometry[g].plugin.kind != "mesh")
      run::put_mesh_in_place({a.geometries[g].surface, a.geometries[g].slots}, c.geometry[g].plugin, c.domain, folder);
  }
  c.output.series.emplace();
  run::write_frames_for_means(c);
  c.run.engine.clear(), c.run.ranks = 1;
  const fs::path file = folder / "case.yaml";
  output::write_file(file, config::resolved_yaml(c, registry.descriptors()));
  require_same_inside(a, run::assemble(config::read_case(file.string()), registry));
  return file;
}

}  // namespace millscope::crosscheck
