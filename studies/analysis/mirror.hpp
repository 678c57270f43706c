// The mirror image of results: a mill that turns the other way, seen from the other end (x → −x).
//
// Angles are counted in the turning sense and powers are positive in normal running, so most results stay as they are. What changes the
// analyzer has said of its results (ResultTrait):
//   - grids along x (an axis with kAlongX): cells in reverse, edges negated;
//   - components along x, and what carries the sign of Omega (kOdd): the sign;
//   - the first of three components (kFirstOdd): the sign;
//   - cumulative shares (kCumulative) along x: the share on the other side.
#pragma once

#include <string>
#include <vector>

#include "studies/analysis/results.hpp"

namespace millscope::analysis {

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

}  // namespace millscope::analysis
