// Beads that a file places: each in its class of the case, none beyond a wall, none deep in another.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kernel/run/insertion.hpp"
#include "kernel/run/sphere_cells.hpp"

namespace millscope::run {
namespace {

using base::UserError;
using config::PlacedBead;

constexpr double kDeepest = 0.05;  // of the smaller radius: snapshots of a run overlap by less, and more flies apart

[[noreturn]] void refuse(const Assembly& a, const PlacedBead& bead, const std::string& why) {
  throw UserError(base::Location{a.c.fill.file, static_cast<int>(bead.line)}, why);
}

/// Bead i and j overlap by more than they may: said with both lines.
void check_overlaps(const Assembly& a, const std::vector<PlacedBead>& beads) {
  Region region;
  double largest = 0;
  region.box.low = region.box.high = beads.front().centre;
  for (const PlacedBead& b : beads) {
    largest = std::max(largest, b.diameter);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      region.box.low[axis] = std::min(region.box.low[axis], b.centre[axis]);
      region.box.high[axis] = std::max(region.box.high[axis], b.centre[axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.c.domain.periodic[axis])
      region.box.low[axis] = a.c.domain.box.low[axis], region.box.high[axis] = a.c.domain.box.high[axis];
    else
      region.box.low[axis] -= largest, region.box.high[axis] += largest;
  }
  SphereCells cells(a, region, largest);
  for (const PlacedBead& b : beads) {
    const double radius = 0.5 * b.diameter;
    const auto hit = cells.overlapping({b.centre, radius}, kDeepest);
    if (hit) {
      const PlacedBead& other = beads[*hit];
      refuse(a, b,
             fmt::format("has a bead that overlaps that of line {} by more than {:g} % of the smaller radius; correct the file, or check "
                         "that its lengths have one unit",
                         other.line, 100 * kDeepest));
    }
    cells.add({b.centre, radius});
  }
}

/// Beyond the ends of what a geometry calls its inside; blocked() looks from its axis alone.
void check_ends(const Assembly& a, const std::vector<PlacedBead>& beads) {
  for (const GeometryUse& g : a.geometries) {
    if (!g.interior.is_bounded) continue;
    for (const PlacedBead& b : beads) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (a.c.domain.periodic[axis] || (b.centre[axis] >= g.interior.low[axis] && b.centre[axis] <= g.interior.high[axis])) continue;
        refuse(
            a, b,
            fmt::format("has a bead at {} = {:.4g} m, beyond a wall that reaches from {:.4g} to {:.4g} m; check the frame and the units of "
                        "the file: z is the mill's axis",
                        "xyz"[axis], b.centre[axis], g.interior.low[axis], g.interior.high[axis]));
      }
    }
  }
}

void check_walls(const Assembly& a, const std::vector<PlacedBead>& beads) {
  std::vector<base::Vector3> centres;
  std::vector<double> radii;
  for (const PlacedBead& b : beads) centres.push_back(b.centre), radii.push_back(0.5 * b.diameter * (1 - kDeepest));
  const std::vector<std::uint8_t> bad = blocked(a, centres, radii);
  const auto first = std::find(bad.begin(), bad.end(), 1);
  if (first == bad.end()) return;
  refuse(
      a, beads[static_cast<std::size_t>(first - bad.begin())],
      fmt::format("has a bead in a wall or beyond it, as {} of {} beads are; check the frame of the file: z is the mill's axis, in metres",
                  std::count(bad.begin(), bad.end(), 1), bad.size()));
}

}  // namespace

void insert_file_beads(Assembly& a) {
  std::vector<PlacedBead> beads = a.c.fill.placed;
  for (PlacedBead& b : beads) {
    for (int axis = 0; axis < 3; ++axis) b.centre[axis] = dem::wrapped(a.system->settings(), axis, b.centre[axis]);
  }
  check_ends(a, beads);
  check_walls(a, beads);
  check_overlaps(a, beads);
  a.system->particles.resize(beads.size());
  for (std::size_t i = 0; i < beads.size(); ++i)
    put_moving(a, i, {beads[i].bead_class, beads[i].diameter}, beads[i].centre, beads[i].velocity, beads[i].spin);
}

}  // namespace millscope::run
