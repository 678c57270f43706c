// Beads of many sizes put at random, the largest first: random sequential addition.
#pragma once

#include <vector>

#include "kernel/run/space.hpp"
#include "millscope/random.hpp"

namespace millscope::run {

struct BeadType {
  std::size_t bead_class;
  double diameter;
};

struct Sphere {
  base::Vector3 centre;
  double radius;
};

/// One centre per bead, none touching another, what is `occupied` or a wall; the lower part of the region is filled first. Throws UserError
/// when they do not fit (random addition ends near a third of the space for equal beads, later for unequal ones).
std::vector<base::Vector3> scattered(const Assembly& a, const Region& region, const std::vector<BeadType>& types, Random& random,
                                     const std::vector<Sphere>& occupied = {});

}  // namespace millscope::run
