#include "studies/engine/liggghts/folder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/error.hpp"
#include "kernel/base/program.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/new_folder.hpp"
#include "kernel/output/stl.hpp"
#include "studies/engine/liggghts/obstacles.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

namespace fs = std::filesystem;

std::size_t write_mesh(const run::Assembly& a, const MeshFile& mesh, const fs::path& folder) {
  const Surface& all = a.geometries[mesh.body].surface;
  const std::vector<std::uint32_t> corners = corners_of(a, mesh);
  const std::vector<std::uint32_t> slots(corners.size() / 3, 0);
  const std::vector<std::string> names{a.c.geometry[mesh.body].plugin.name};
  output::write_stl(folder / mesh.file, {all.vertex_count, all.vertices, slots.size(), corners.data(), slots.data()}, names);
  return slots.size();
}

std::string readme(const run::Assembly& a, const host::Registry& registry, const Exported& exported) {
  std::string text = fmt::format(R"(# {}: for LIGGGHTS

    liggghts -in in.liggghts                      # LIGGGHTS-PUBLIC 3.8; Debian: apt install liggghts
    mpirun -np 4 liggghts -in in.liggghts         # on four cores
    millscope import . -o ../out                  # afterwards: files as of a run of millscope

Made by millscope {}: {} beads, {} steps of {:.4g} s, {} triangles of walls.

| file | holds |
|---|---|
| `in.liggghts` | the case: materials, contact model, walls, motion, output |
| `beads.data` | the beads where millscope puts them, before they settle |
| `meshes/` | the walls, in metres, one file for each geometry and material |
| `case.resolved.yaml` | the case with all its values, for `millscope import` |
| `post/` | what comes out: `series.txt` (energies in J, centre of mass in m, torque on each wall in N m), `frame_*.txt` (beads), restart files |

Up to step {} the charge falls with the walls at rest; the case's own time begins there.

## What LIGGGHTS defines in its own way

)",
                                 a.c.name, base::version(), exported.beads, exported.steps, a.time_step, exported.triangles, zero_step(a));
  for (const std::string& difference : differences_of(a, registry)) text += "- " + difference + ".\n";
  return text;
}

}  // namespace

Exported write_case(const run::Assembly& a, const host::Registry& registry, const fs::path& folder) {
  output::NewFolder aside(folder);
  Exported exported;
  exported.beads = static_cast<std::size_t>(a.system->particles.count());
  exported.steps = a.end_step - a.first_step;
  for (const char* name : {"meshes", "post"}) fs::create_directory(aside.path() / name);
  const std::vector<MeshFile> meshes = meshes_of(a);
  exported.meshes = meshes.size();
  for (const MeshFile& mesh : meshes) exported.triangles += write_mesh(a, mesh, aside.path());
  output::write_file(aside.path() / "beads.data", data_of(a));
  output::write_file(aside.path() / "in.liggghts", script_of(a, physics_of(a, registry), meshes));
  output::write_file(aside.path() / output::kResolvedCase, config::resolved_yaml(a.c, registry.descriptors()));
  output::write_file(aside.path() / "README.md", readme(a, registry, exported));
  aside.publish();
  return exported;
}

Exported export_case(run::Assembly& a, const host::Registry& registry, const fs::path& folder) {
  require_playable(a, registry);
  output::refuse_folder(folder);
  run::insert_beads(a);
  return write_case(a, registry, folder);
}

}  // namespace millscope::engine::liggghts
