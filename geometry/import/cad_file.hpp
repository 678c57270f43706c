// CAD bodies (STEP, IGES) as triangles, by OpenCASCADE. It is big and reads what strangers wrote, so it stands in a program of its own,
// `read_cad`, which is started for a file and ends with it: no other run loads it.
#pragma once

#include <string>

#include "geometry/import/guarded_import.hpp"

namespace millscope::geometry {

inline constexpr char kCadExtensions[] = "step|stp|iges|igs";

struct Tessellation {
  double chord = 2.5e-4;   ///< largest distance between a face and its triangles, m of the drawing
  double angle = 0.2;      ///< largest angle between neighbouring triangles of a curved face, rad
  bool by_colour = false;  ///< slots by the colours of faces, not by the names of bodies
};

/// Of this file: how long it may take and how much memory.
ImportLimits cad_limits(std::size_t max_triangles);

/// Triangles in mm, whatever unit the file is in; one slot per body's name or per colour. Throws Refusal: file, reason, remedy.
Soup import_cad(const std::string& path, const ImportLimits& limits, const Tessellation& tessellation);

}  // namespace millscope::geometry
