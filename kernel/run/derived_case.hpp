// Cases that a study derives from the user's: triangles for a liner, a charge by its count, output for means.
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

/// That many beads are filled in, however the case said it; those of a file begin where it puts them.
void fill_by_count(config::Case& c, std::uint64_t beads);

/// Of beads and walls only frames from the start of the analysis on, half as far apart as a charge takes to forget its kinetic energy.
void write_frames_for_means(config::Case& c);

}  // namespace millscope::run
