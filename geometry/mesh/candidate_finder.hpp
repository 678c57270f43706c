// Which triangles each bead may touch until the next rebuild.
//
// The mesh never moves in its own frame, so what is near a place stays near it: space is cut into cells, and FCL's broadphase (a tree of
// spheres round the cells against a tree of triangles) is asked once for each cell that a bead enters. A rebuild then costs a bead one
// look-up and, near the wall, an exact distance to the few triangles of its cell. Asking FCL for every bead at every rebuild gave the
// same candidates at 1.5 to 6 µs a bead instead of 0.1 to 0.3.
#pragma once

#include <memory>
#include <shared_mutex>
#include <span>
#include <vector>

#include "geometry/mesh/cell_grid.hpp"
#include "geometry/mesh/triangle_record.hpp"
#include "millscope/geometry.hpp"

namespace millscope::geometry {

class CandidateFinder {
 public:
  explicit CandidateFinder(const Triangles& triangles);
  ~CandidateFinder();

  /// Sends every triangle within radius + margin of each bead to the sink: beads in order, triangles ascending. From many threads at once.
  void find(const GeometryBeads& beads, double margin, const CandidateSink& sink);

 private:
  struct Trees;
  struct NearBead {
    std::int64_t bead;
    std::uint32_t entry;  // of the grid
  };
  void prepare(double reach);
  void look_up(const GeometryBeads& beads, std::vector<NearBead>& near, std::vector<std::uint64_t>& unknown) const;
  void learn(std::vector<std::uint64_t>& unknown);
  void resolve(std::span<const std::uint64_t> cells);
  void send(const NearBead& near, const GeometryBeads& beads, double margin, const CandidateSink& sink) const;

  const Triangles& triangles_;
  Bounds box_;
  std::shared_mutex known_;  // of what follows: many read, one learns
  CellGrid grid_;
  double distance_ = 0;               // the cells' lists are good for radius + margin up to this
  std::vector<std::uint32_t> lists_;  // of the cells: a count, then that many triangles, ascending
  std::unique_ptr<Trees> trees_;
};

}  // namespace millscope::geometry
