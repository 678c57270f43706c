// What a child process says of the file that it reads, through a pipe: its solids, or why it refuses.
#pragma once

#include <string>
#include <vector>

#include "geometry/mesh/soup.hpp"

namespace millscope::geometry {

struct Solid {
  std::string name;             ///< "" where the file gives none
  std::vector<double> corners;  ///< nine per triangle
};

/// What a file of triangles holds.
struct Solids {
  std::vector<Solid> solids;
  std::vector<std::string> notes;  ///< for the report
  bool single_precision = true;
};

/// By the child. Solids of one name become one slot; throws Refusal for more slots than anyone gives materials to.
void send_solids(int pipe, const Solids& file);
void send_refusal(int pipe, const char* reason);

/// By the host. False: the answer is not complete. Throws Refusal with the child's reason.
bool parse_answer(const std::vector<char>& answer, Soup& soup);

}  // namespace millscope::geometry
