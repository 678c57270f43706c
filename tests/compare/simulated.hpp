// Two made-up sources with known truth: blocks of a bead's walk through scalars, curves and a map, resampled as `analyze` does it.
#pragma once

#include <cstdint>
#include <vector>

#include "studies/compare/family_test.hpp"

namespace compare_test {

/// What is put into source B and not into A, in standard deviations of one block's value.
struct Shift {
  double scalar = 0;  ///< of the first single number
  double cell = 0;    ///< of four neighbouring cells of the map
};

struct Design {
  std::size_t blocks_a = 40, blocks_b = 40;
  std::size_t draws = 200;
  Shift shift = {};
};

/// Three numbers, two curves of 30 bins and a map of 20 × 20 cells. Numbers are normal and correlated with each other; bins are shares
/// that sum to one; cells are gamma-distributed (many small values, few large ones) and correlated with their neighbours.
std::vector<millscope::compare::TestedObservable> simulate(const Design& design, std::uint64_t seed);

inline constexpr std::size_t kMapSide = 20;
inline constexpr std::size_t kMapObservable = 5;  ///< index of the map

}  // namespace compare_test
