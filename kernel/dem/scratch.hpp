// One worker's memory: the arrays of a batch, of the wall query before it, and of body forces.
#pragma once

#include <vector>

#include "kernel/dem/aligned.hpp"
#include "kernel/dem/batch.hpp"
#include "millscope/geometry.hpp"

namespace millscope::dem {

/// What the kernel notes of a contact that the geometry found.
struct FoundContact {
  static constexpr int kOutOfReach = -1;
  static constexpr std::int64_t kFresh = -1;
  int physics_index;  ///< or kOutOfReach
  std::int64_t last;  ///< its place in WallList::active, or kFresh
};

struct Scratch {
  explicit Scratch(int history_count);
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  PairBatch pairs{};
  WallBatch walls{};  ///< shares most of the memory of `pairs`: a worker is at one batch at a time
  double* query_position[3];
  double* query_radius;
  GeometryContacts found{};
  std::uint32_t* triangle;             ///< for found.triangle, where a body keeps work per triangle
  std::vector<FoundContact> contacts;  ///< one for each of `found`
  BodyForceArrays bodies{};
  AlignedVector<ForceLine> ring;  ///< for ForceWindow; zero between steps

 private:
  AlignedVector<double> doubles_;
  std::vector<std::uint32_t> integers_;
  std::vector<std::int32_t> signed_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace millscope::dem
