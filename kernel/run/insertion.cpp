// Filling the mill: sites of a loosened hexagonal packing, lowest first, none touching a wall or on its far side. Where sizes differ so
// much that the sites of the largest bead do not suffice, beads are scattered instead (scatter.cpp).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/run/insertion.hpp"
#include "kernel/run/warm_start.hpp"

namespace millscope::run {
namespace {

using base::UserError;
constexpr double kSpacing = 1.04;   // of the largest diameter: neighbouring sites, so that jitter leaves no overlap
constexpr double kMostSites = 4e9;  // of the whole lattice: beyond, walking through it takes minutes

/// Sites below `top` of a hexagonal close packing with neighbour distance `spacing`, stretched to fit a periodic axis z exactly.
std::vector<base::Vector3> sites_of(const Assembly& a, const Region& r, double diameter, double top) {
  const double spacing = kSpacing * diameter;
  const auto periodic = [&a](std::size_t axis) { return a.c.domain.periodic[axis]; };
  // Rows along z (periodic in slices): row distance in y, layers in x are those of a hexagonal packing.
  const double extent[3] = {r.box.high[0] - r.box.low[0], r.box.high[1] - r.box.low[1], r.box.high[2] - r.box.low[2]};
  const double ideal[3] = {spacing * std::sqrt(2.0 / 3.0), spacing * std::sqrt(3.0) / 2, spacing};
  double step[3], origin[3];
  int count[3];
  double all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) all *= std::max(1.0, extent[axis] / ideal[axis]);
  if (all > kMostSites) {
    throw UserError(a.c.fill.where,
                    fmt::format("the space to fill has {:.1e} places for beads of {:.4g} m; bound it with fill.region: {{low: "
                                "[x, y, z], high: [x, y, z]}}, or check the units of bead and mill",
                                all, diameter));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double usable = periodic(axis) ? extent[axis] : extent[axis] - diameter;
    const double cells = usable / ideal[axis];
    count[axis] = std::max(0, static_cast<int>(std::floor(cells))) + (periodic(axis) ? 0 : 1);
    // An even number of rows closes the stagger over a periodic boundary.
    if (periodic(axis) && axis != 2 && count[axis] % 2) --count[axis];
    step[axis] = periodic(axis) && count[axis] > 0 ? extent[axis] / count[axis] : ideal[axis];
    origin[axis] = r.box.low[axis] + (periodic(axis) ? 0.0 : 0.5 * diameter);
  }
  std::vector<base::Vector3> sites;
  for (int layer = 0; layer < count[0]; ++layer) {
    for (int row = 0; row < count[1]; ++row) {
      for (int k = 0; k < count[2]; ++k) {
        const double shift_z = 0.5 * ((row + layer) % 2) * step[2], shift_y = layer % 2 ? step[1] / 3 : 0.0;
        base::Vector3 p{origin[0] + layer * step[0], origin[1] + row * step[1] + shift_y, origin[2] + k * step[2] + shift_z};
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (!periodic(axis)) inside = inside && p[axis] <= r.box.high[axis] - 0.5 * diameter;
        }
        if (r.cylinder) inside = inside && std::hypot(p[0] - r.axis_point[0], p[1] - r.axis_point[1]) <= r.radius - 0.5 * diameter;
        if (inside && height(a, p) <= top) sites.push_back(p);
      }
    }
  }
  return sites;
}

/// The lowest `bead_count` free sites of the lattice, or all when it has fewer. Grows from below, so that a large vessel with few beads
/// costs little.
std::vector<base::Vector3> lattice_sites(const Assembly& a, const Region& region, double jitter) {
  const double diameter = a.c.largest_diameter(), cell = std::pow(kSpacing * diameter, 3) / std::numbers::sqrt2;
  for (double part = first_part(a, region, 8 * static_cast<double>(a.bead_count) * cell);; part = std::min(1.0, 2 * part)) {
    std::vector<base::Vector3> sites = sites_of(a, region, diameter, level(a, region, part));
    const std::vector<std::uint8_t> bad = blocked(a, sites, 0.5 * diameter + 2 * jitter);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      if (!bad[i]) sites[kept++] = sites[i];
    }
    sites.resize(kept);
    if (kept >= a.bead_count) {
      // Lowest first; ties by position so that the choice is the same everywhere.
      std::sort(sites.begin(), sites.end(), [&a](const base::Vector3& p, const base::Vector3& q) {
        const double hp = height(a, p), hq = height(a, q);
        return hp != hq ? hp < hq : p < q;
      });
      sites.resize(a.bead_count);
      return sites;
    }
    if (part >= 1) return sites;
  }
}

/// Beads that cannot fit are refused before memory is asked for them.
void refuse_too_many(const Assembly& a, const Region& region, std::size_t places) {
  if (places >= a.bead_count) return;
  if (a.c.smallest_diameter() == a.c.largest_diameter()) {
    throw UserError(a.c.fill.where,
                    fmt::format("{} beads are asked for but only {} fit without touching; lower the filling, or check that the liner is in "
                                "the right unit (millscope geometry report)",
                                a.bead_count, places));
  }
  double space = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) space *= region.box.high[axis] - region.box.low[axis];
  const double volume = static_cast<double>(a.bead_count) * a.c.mean_bead_volume();
  if (volume <= space) return;
  throw UserError(a.c.fill.where,
                  fmt::format("{} beads of {:.4g} m^3 are asked for, but the space to fill has {:.4g} m^3; lower the filling", a.bead_count,
                              volume, space));
}

}  // namespace

std::vector<BeadType> draw_types(const Assembly& a, std::uint64_t count, Random& random) {
  struct Share {
    BeadType type;
    double exact;
    std::uint64_t number;
  };
  std::vector<Share> shares;
  std::uint64_t given = 0;
  for (std::size_t b = 0; b < a.c.beads.size(); ++b) {
    for (const config::SizeClass& s : a.c.beads[b].sizes) {
      const double exact = static_cast<double>(count) * a.c.beads[b].number_share * s.number_fraction;
      shares.push_back({{b, s.diameter}, exact, static_cast<std::uint64_t>(exact)});
      given += shares.back().number;
    }
  }
  std::vector<std::size_t> order(shares.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&shares](std::size_t p, std::size_t q) {
    return shares[p].exact - static_cast<double>(shares[p].number) > shares[q].exact - static_cast<double>(shares[q].number);
  });
  for (std::size_t i = 0; given < count; ++i, ++given) ++shares[order[i % order.size()]].number;
  std::vector<BeadType> types;
  for (const Share& s : shares) types.insert(types.end(), s.number, s.type);
  types.resize(count);
  random.shuffle(types);
  return types;
}

void put_bead(Assembly& a, std::size_t i, const BeadType& type, const base::Vector3& centre) {
  dem::Particles& p = a.system->particles;
  const config::BeadCase& bead = a.c.beads[type.bead_class];
  const double radius = 0.5 * type.diameter, mass = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * bead.density;
  p.position[i] = {centre[0], centre[1], centre[2], radius};
  dem::MotionLine line{};
  line.inverse_mass = 1 / mass;
  line.inverse_inertia = 1 / (0.4 * mass * radius * radius);
  p.motion[i] = p.half[i] = line;
  p.force[i] = dem::ForceLine{};
  p.acceleration[i] = dem::AccelerationLine{};
  p.id[i] = static_cast<std::uint32_t>(i);
  p.material[i] = static_cast<std::uint8_t>(std::find(a.materials.begin(), a.materials.end(), bead.material) - a.materials.begin());
}

void put_moving(Assembly& a, std::size_t i, const BeadType& type, const base::Vector3& centre, const base::Vector3& velocity,
                const base::Vector3& spin) {
  put_bead(a, i, type, centre);
  for (dem::MotionLine* line : {&a.system->particles.motion[i], &a.system->particles.half[i]}) {
    std::copy_n(velocity.data(), 3, line->v);
    std::copy_n(spin.data(), 3, line->w);
  }
}

void insert_beads(Assembly& a) {
  if (a.c.start) return take_over_beads(a);
  if (!a.c.fill.file.empty()) return insert_file_beads(a);
  Random random(a.c.seed);
  const double jitter = 0.25 * (kSpacing - 1) * a.c.largest_diameter();
  const Region region = region_of(a);
  std::vector<base::Vector3> centres = lattice_sites(a, region, jitter);
  refuse_too_many(a, region, centres.size());
  const std::vector<BeadType> types = draw_types(a, a.bead_count, random);
  a.system->particles.resize(a.bead_count);
  if (centres.size() < a.bead_count) {
    centres = scattered(a, region, types, random);
  } else {
    const auto shake = [&random, jitter] { return jitter * (2 * random.uniform() - 1) / std::numbers::sqrt3; };
    for (base::Vector3& c : centres) {
      for (double& x : c) x += shake();
    }
  }
  for (std::size_t i = 0; i < a.bead_count; ++i) put_bead(a, i, types[i], centres[i]);
}

}  // namespace millscope::run
