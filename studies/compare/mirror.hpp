// The mirror image of results: a mill that turns the other way, seen from the other end (x → −x).
//
// Angles are counted in the turning sense and powers are positive in normal running, so most results stay as they are. What changes:
//   - grids along x: cells in reverse, edges negated;
//   - components along x (the word "x" in the name, a length, velocity, acceleration or force): the sign;
//   - the first of three components, where the description ends "x, y, z.": the sign;
//   - what carries the sign of Omega or of x, which its description says ("clockwise", "sign is that of Omega", "towards +x"): the sign;
//   - cumulative shares along x: the share on the other side.
#pragma once

#include <string>
#include <vector>

#include "studies/analysis/results.hpp"

namespace millscope::studies {

/// What happens to one result.
struct MirrorRule {
  std::vector<bool> reversed;  ///< for each dimension
  bool changes_sign = false;
  bool first_changes_sign = false;
  double complement = 0;  ///< not 0: becomes this less its value (cumulative shares, 1 or 100 %)
  bool changes() const;
};

MirrorRule mirror_rule(const ResultSet& results, const ResultArray& array);

/// Mirrors all results; `done` receives one phrase for each kind of change that was made.
ResultSet mirrored(const ResultSet& results, std::vector<std::string>& done);

}  // namespace millscope::studies
