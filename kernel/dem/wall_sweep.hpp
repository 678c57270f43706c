// The beads of one slab at the walls in one step: the geometry finds the contacts of the beads near it, the physics is run pair by pair of
// materials.
#pragma once

#include <vector>

#include "kernel/dem/slab.hpp"
#include "kernel/dem/wall_lists.hpp"

namespace millscope::dem {

class WallSweep {
 public:
  /// `poses`: of the bodies at this step.
  WallSweep(const SlabPass& pass, WallLists& walls, const std::vector<WallPose>& poses);

  /// The contacts of the beads before `end` that have not been through this step yet.
  void until(std::int64_t end);
  void end();

 private:
  /// Beads that are near one body, a few at a time, and the contacts found for them.
  struct Chunk {
    int body;
    std::int64_t begin, count;  ///< of WallList::bead
    std::int64_t base = 0;      ///< its first contact in WallList::next
    std::uint64_t present = 0;  ///< bit p mod 64: it may have contacts of physics p
  };
  Chunk next_chunk(int body, std::int64_t end);
  void run(Chunk& chunk);
  void ask(const Chunk& chunk);
  void match(Chunk& chunk);
  std::int64_t gather(const Chunk& chunk, int physics_index);
  void scatter(const Chunk& chunk, int physics_index, std::int64_t count);
  void book_triangle(const Chunk& chunk, const PairPhysics& physics, std::int64_t place);
  void wear(const Chunk& chunk, int physics_index, std::int64_t count);

  const SlabPass& pass_;
  WallLists& walls_;
  const std::vector<WallPose>& poses_;
};

}  // namespace millscope::dem
