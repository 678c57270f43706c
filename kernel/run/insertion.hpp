// What filling a mill and taking another run's beads over share.
#pragma once

#include <vector>

#include "kernel/run/scatter.hpp"

namespace millscope::run {

/// How many of each class and size: largest remainders, so that the numbers add up and no seed changes them; then shuffled.
std::vector<BeadType> draw_types(const Assembly& a, std::uint64_t count, Random& random);

/// Bead `i`, at rest.
void put_bead(Assembly& a, std::size_t i, const BeadType& type, const base::Vector3& centre);

}  // namespace millscope::run
