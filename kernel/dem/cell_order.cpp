#include "kernel/dem/cell_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "kernel/base/error.hpp"

namespace millscope::dem {
namespace {

double speed(const MotionLine& m) { return std::sqrt(m.v[0] * m.v[0] + m.v[1] * m.v[1] + m.v[2] * m.v[2]); }

/// The skin is cut by what rounding to single precision may hide of a displacement.
ReferenceLine reference_of(const PositionLine& x, double skin) {
  const double* c = x.centre;
  const double hidden = 2e-7 * (std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2])), allowed = std::max(0.0, skin - hidden);
  return {{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])}, static_cast<float>(allowed * allowed)};
}

/// A single that is no less.
float rounded_up(double a) { return static_cast<float>(a * (1 + 2e-7)); }

/// Of one slab.
struct Measured {
  Extent extent;
  std::optional<std::int64_t> lost;  ///< a bead outside the domain
};

}  // namespace

/// Wraps, and finds reaches and references.
Extent CellOrder::measure(Particles& p, double time) {
  const Settings& settings = common_.settings;
  double largest_radius = 0;
  for (const PositionLine& x : p.position) largest_radius = std::max(largest_radius, x.radius);
  const double law_reach = common_.physics.reach();
  reach_.resize(p.position.size());
  std::vector<Measured> measured(common_.slabs.count);
  common_.each_slab([&](int slab, int) {
    Measured& m = measured[slab];
    for (std::int64_t i = common_.slabs.begin(slab); i < common_.slabs.end(slab); ++i) {
      PositionLine& x = p.position[i];
      for (int a = 0; a < 3; ++a) {
        double& c = x.centre[a];
        c = wrapped(settings, a, c);
        if (!(c >= settings.low[a] && c <= settings.high[a])) m.lost = i;
        m.extent.low[a] = std::min(m.extent.low[a], c);
        m.extent.high[a] = std::max(m.extent.high[a], c);
      }
      const double skin = std::min(settings.skin_cap * largest_radius,
                                   settings.skin_base * x.radius + settings.skin_steps * settings.time_step * speed(p.motion[i]));
      reach_[i] = rounded_up(x.radius + skin + 0.5 * law_reach);
      p.reference[i] = reference_of(x, skin);
      m.extent.reach = std::max(m.extent.reach, static_cast<double>(reach_[i]));
    }
  });
  Extent all;
  for (const Measured& m : measured) {
    if (m.lost) throw base::UserError(complaint(p, *m.lost, time, "has left the domain"));
    all.reach = std::max(all.reach, m.extent.reach);
    for (int a = 0; a < 3; ++a) {
      all.low[a] = std::min(all.low[a], m.extent.low[a]);
      all.high[a] = std::max(all.high[a], m.extent.high[a]);
    }
  }
  return all;
}

/// Brings values into the new order, over other memory that is free.
template <class Values>
void CellOrder::permute(Values& values, AlignedVector<ForceLine>& other_half) {
  using Item = typename Values::value_type;
  static_assert(sizeof(Item) <= sizeof(ForceLine));
  unsigned char* const there = reinterpret_cast<unsigned char*>(other_half.data());
  common_.each_slab([&](int slab, int) {
    for (std::int64_t i = common_.slabs.begin(slab); i < common_.slabs.end(slab); ++i) {
      std::memcpy(there + new_index_[i] * sizeof(Item), &values[i], sizeof(Item));
    }
  });
  common_.each_slab([&](int slab, int) {
    const BeadRange beads = common_.slabs.range(slab);
    std::memcpy(static_cast<void*>(values.data() + beads.begin), there + beads.begin * sizeof(Item),
                (beads.end - beads.begin) * sizeof(Item));
  });
}

void CellOrder::renew(Particles& p, double time) {
  const Extent extent = measure(p, time);
  grid_.fit(common_.settings, extent, p.count());
  new_index_.resize(p.position.size());
  common_.each_slab([&](int slab, int) {
    for (std::int64_t i = common_.slabs.begin(slab); i < common_.slabs.end(slab); ++i) new_index_[i] = grid_.cell_of(p.position[i]);
  });
  grid_.number(new_index_);
  // Between steps the forces are zero and their lines are free: the largest of all serve as the other half.
  permute(p.acceleration, p.force);
  permute(p.motion, p.force);
  permute(p.half, p.force);
  permute(p.position, p.force);
  permute(p.reference, p.force);
  permute(reach_, p.force);
  permute(p.id, p.force);
  permute(p.material, p.force);
  place(p, extent);
}

/// Singles for `near`. With u = 2⁻²⁴ and the largest length L, rounding takes up to u L from a coordinate, up to 6 u L from a difference
/// between two images, and so up to 11 u L and 4 u of itself from a distance: each of the two beads bears half of more than that.
void CellOrder::place(const Particles& p, const Extent& extent) {
  constexpr double kHidden = 5e-7;
  double largest = extent.reach;
  for (int a = 0; a < 3; ++a) {
    largest = std::max({largest, extent.high[a] - extent.low[a], common_.settings.periodic.length[a]});
    centre_[a].resize(p.position.size() + kNearLanes);
  }
  near_reach_.resize(p.position.size() + kNearLanes);
  const float hidden = rounded_up(kHidden * (largest + extent.reach));
  common_.each_slab([&](int slab, int) {
    for (std::int64_t i = common_.slabs.begin(slab); i < common_.slabs.end(slab); ++i) {
      for (int a = 0; a < 3; ++a) centre_[a][i] = static_cast<float>(p.position[i].centre[a] - extent.low[a]);
      near_reach_[i] = reach_[i] + hidden;
    }
  });
}

std::int64_t CellOrder::near(BeadRange owners, const Neighbourhood& round, const NearSlots& found) const {
  const NearPlaces places{{centre_[0].data(), centre_[1].data(), centre_[2].data()}, near_reach_.data()};
  return common_.wide.near(places, common_.settings.periodic, owners, round.ranges.data(), round.count, found);
}

}  // namespace millscope::dem
