// A case as a folder that LIGGGHTS runs, here or elsewhere.
#pragma once

#include <filesystem>

#include "kernel/host/registry.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::engine::liggghts {

/// What was written.
struct Exported {
  std::size_t beads = 0, meshes = 0, triangles = 0;
  std::int64_t steps = 0;  ///< settling among them
};

/// Of beads that are in (run::insert_beads): writes in.liggghts, beads.data, meshes/, the resolved case and README.md; whole or not
/// at all. Throws base::UserError with one line for each obstacle (obstacles.hpp).
Exported write_case(const run::Assembly& a, const host::Registry& registry, const std::filesystem::path& folder);

/// Puts the beads in as a run of millscope does, and writes the same. Throws base::UserError with one line for each obstacle
/// (obstacles.hpp).
Exported export_case(run::Assembly& a, const host::Registry& registry, const std::filesystem::path& folder);

}  // namespace millscope::engine::liggghts
