// What two engines say of the same starts, held against each other.
//
//   d_s = their value − ours, of seed s;  d: mean over n seeds;  e = sd(d_s)/√n;  t = d/e with n − 1 degrees of freedom
//
// One start is one pair: the values of the two engines may share what the start has left in the charge. The p-values of all quantities
// together are Holm's (1979), a bound that holds however they hang together.
//
// Within a limit L:   agree        |d| + k e ≤ L      k: 2, or the 97.5 % point of t where that is more (few seeds)
//                     differ       |d| − k e > L
//                     unresolved   else; n (k e/(|d| − L))² seeds would resolve it, the rest being the same
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/crosscheck/measure.hpp"

namespace millscope::crosscheck {

struct Limits {
  double power = 0.005;       ///< of ours
  double centre = 0.3e-3;     ///< m, of the centre of mass, x and y each
  double translation = 0.01;  ///< of ours, of the translational energy
};

enum class Judgement { none, agree, differ, unresolved };
const char* text(Judgement judgement);

struct Mean {
  double value = 0, error = 0;  ///< over the seeds
};

struct Compared {
  std::string name, unit;
  Mean ours, theirs, difference;
  double p = 1, adjusted_p = 1;
  std::optional<double> limit = {};  ///< in `unit`
  Judgement judgement = Judgement::none;
  double seeds_needed = 0;  ///< with a limit
};

/// The quantities of one run for each seed, ours[s] and theirs[s] from the same start: at least 2, and the same quantities in each.
std::vector<Compared> agreement(const std::vector<std::vector<Quantity>>& ours, const std::vector<std::vector<Quantity>>& theirs,
                                const Limits& limits);

}  // namespace millscope::crosscheck
