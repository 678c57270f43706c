// Reads a mesh file in a child process with a memory limit and a time limit, since the library that parses it may hang, crash or
// allocate without end on a damaged or hostile file. The host only waits: whatever happens in the child becomes a one-line refusal.
#pragma once

#include <string>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

struct ImportLimits {
  std::size_t max_triangles = 5'000'000;
  double base_seconds = 15, seconds_per_megabyte = 1;  ///< time-out
  std::size_t base_bytes = std::size_t{768} << 20;     ///< memory of the child beyond the host's
  std::size_t bytes_per_byte = 60;                     ///< … plus this per byte of the file, at most bytes_per_triangle × max_triangles
  std::size_t bytes_per_triangle = 1200;
};

/// Triangles in the file's own unit, one slot per solid name. Throws Refusal: file, reason, remedy.
Soup import_mesh(const std::string& path, const ImportLimits& limits);

/// What the child does: reads `path` and writes the triangles to `pipe`. Never returns.
[[noreturn]] void import_child(int pipe, const std::string& path, const std::string& extension, std::size_t max_triangles) noexcept;

/// Kinds of block that the child writes: an octet, then for `solid` a name (32-bit length) and triangles (64-bit count, nine doubles
/// each); for `note` a sentence for the report; for `refused` a message (32-bit lengths); `done` ends a complete answer.
enum class Block : char { solid = 'S', note = 'N', refused = 'R', done = 'D' };

}  // namespace millscope::geometry
