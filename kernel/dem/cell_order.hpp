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
  /// Of a bead by its new number: radius + skin + half the largest reach of a law, m; rounded up.
  double reach(std::int64_t bead) const { return reach_[bead]; }
  const CellGrid& grid() const { return grid_; }
  /// Lists the pairs of some beads i of a cell with the beads j < i of its neighbourhood whose reach overlaps their own. There is `room`
  /// for them. Returns their number.
  std::int64_t near(BeadRange owners, const Neighbourhood& round, const NearSlots& found) const;
  static std::int64_t room(BeadRange owners, const Neighbourhood& round) { return (owners.end - owners.begin) * round.beads + kNearLanes; }

  template <class Visit>
  void each_idle(Visit& visit) const {
    for (const AlignedVector<float>& c : centre_) visit.idle(c);
    visit.idle(reach_);
    visit.idle(near_reach_);
    visit.idle(new_index_);
  }

 private:
  Extent measure(Particles& particles, double time);
  template <class Values>
  void permute(Values& values, AlignedVector<ForceLine>& other_half);
  void place(const Particles& particles, const Extent& extent);

  Common& common_;
  CellGrid grid_;
  AlignedVector<float> reach_;
  AlignedVector<float> centre_[3], near_reach_;  ///< as NearPlaces
  std::vector<std::uint32_t> new_index_;
};

}  // namespace millscope::dem
