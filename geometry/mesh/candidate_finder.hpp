// Which triangles each bead may touch until the next rebuild: FCL's broadphase, one tree of beads against one of triangles.
//
// Both trees persist. The mesh's own frame never turns, so the triangle tree is made once; the tree of beads is refitted, and made
// anew when the number of beads near the wall has drifted (a bead's slot in the tree changes as the host re-sorts its beads, but the
// host sorts in cell order, so slots stay near their place).
#pragma once

#include <memory>

#include "geometry/mesh/near_grid.hpp"
#include "millscope/geometry.hpp"

namespace millscope::geometry {

class CandidateFinder {
 public:
  explicit CandidateFinder(const std::vector<TriangleRecord>& records);
  ~CandidateFinder();

  /// Sends every triangle within radius + margin of each bead to the sink: beads in order, triangles ascending.
  void find(const GeometryBeads& beads, double margin, const CandidateSink& sink);

 private:
  struct Trees;
  const std::vector<TriangleRecord>& records_;
  NearGrid grid_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace millscope::geometry
