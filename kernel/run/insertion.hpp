// What filling a mill and taking another run's beads over share.
#pragma once

#include <vector>

#include "kernel/run/scatter.hpp"

namespace millscope::run {

/// How many of each class and size: largest remainders, so that the numbers add up and no seed changes them; then shuffled.
std::vector<BeadType> draw_types(const Assembly& a, std::uint64_t count, Random& random);

/// Bead `i`, at rest.
void put_bead(Assembly& a, std::size_t i, const BeadType& type, const base::Vector3& centre);
/// Bead `i` as it moves: m/s, rad/s.
void put_moving(Assembly& a, std::size_t i, const BeadType& type, const base::Vector3& centre, const base::Vector3& velocity,
                const base::Vector3& spin);

/// Of fill.file: where the file puts them. Throws base::UserError with the line of a bead that has no class in the case, lies beyond a wall
/// or the domain, or overlaps by more than 5 % of the smaller radius (file_beads.cpp).
void insert_file_beads(Assembly& a);

}  // namespace millscope::run
