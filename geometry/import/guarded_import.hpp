// Reads a file in a child process with a memory limit and a time limit, since the library that parses it may hang, crash or allocate
// without end on a damaged or hostile file. The host only waits: whatever happens in the child becomes a one-line refusal.
#pragma once

#include <functional>
#include <string>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

struct ImportLimits {
  std::size_t max_triangles = 5'000'000;
  double base_seconds = 15, seconds_per_megabyte = 1;  ///< time-out
  std::size_t base_bytes = std::size_t{768} << 20;     ///< memory of the child beyond the host's
  std::size_t bytes_per_byte = 60;                     ///< … plus this per byte of the file, at most bytes_per_triangle × max_triangles
  std::size_t bytes_per_triangle = 1200;

  std::size_t most_bytes() const { return (std::size_t{1} << 20) + 400 * max_triangles; }  ///< a text STL has about 270 bytes a triangle
};

/// What the child does: writes its answer (answer.hpp) to the pipe, or throws.
using ReadInChild = std::function<void(int pipe)>;

/// Triangles in the file's own unit, one slot per solid name. Throws Refusal: reason, remedy; the caller says which file.
Soup read_guarded(const std::string& path, const ImportLimits& limits, const ReadInChild& read);

/// "stl" of "a/Liner.STL"; "" where there is none.
std::string lower_extension(const std::string& path);

}  // namespace millscope::geometry
