// A case whose liner is triangles in place of what the user wrote.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kernel/config/case.hpp"
#include "millscope/geometry.hpp"

namespace millscope::run {

/// Triangles and the names of their material slots.
struct Triangles {
  const Surface& surface;
  std::span<const std::string> slots;
};

/// Writes FOLDER/NAME.stl and makes the geometry a mesh of it. Where the triangles reach from one end of the period along z to the other,
/// the mesh goes on there. UserError when the file cannot be written.
void put_mesh_in_place(const Triangles& triangles, config::PluginInstance& plugin, const config::DomainCase& domain,
                       const std::filesystem::path& folder);

}  // namespace millscope::run
