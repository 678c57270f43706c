// The order of the beads, renewed at each rebuild: by cells, so that neighbours in space are neighbours in memory. A bead's skin grows with
// its speed at that moment.
#pragma once

#include "kernel/dem/cell_grid.hpp"
#include "kernel/dem/particles.hpp"

namespace millscope::dem {

class CellOrder {
 public:
  explicit CellOrder(Common& common) : common_(common) {}

  /// Wraps periodic coordinates, gives each bead its skin, and sorts all beads by cell. UserError where one has left the domain.
  void renew(Particles& particles, double time);

  /// New numbers of the beads by their old ones.
  const std::vector<std::uint32_t>& new_index() const { return new_index_; }
  /// In the new order. Centre; `radius`: radius + skin + half the largest reach of a law.
  const AlignedVector<PositionLine>& reaches() const { return reaches_; }
  const CellGrid& grid() const { return grid_; }
  /// The beads j < i of a neighbourhood whose reach overlaps that of bead i go to `found`, which has `room` for them. Returns their number.
  std::int64_t near(std::int64_t i, const Neighbourhood& round, std::uint32_t* found) const;
  static std::int64_t room(const Neighbourhood& round) { return round.beads + 1; }  // one is written behind the last

  template <class Visit>
  void each_idle(Visit& visit) const {
    visit.idle(reaches_);
    visit.idle(new_index_);
  }

 private:
  Extent measure(Particles& particles, double time);
  template <class Values>
  void permute(Values& values, AlignedVector<ForceLine>& other_half);

  Common& common_;
  CellGrid grid_;
  AlignedVector<PositionLine> reaches_;
  std::vector<std::uint32_t> new_index_;
};

}  // namespace millscope::dem
