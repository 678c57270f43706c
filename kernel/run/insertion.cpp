// Filling the mill: sites of a loosened hexagonal packing, lowest first, none touching a wall or on its far side.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/run/assembly.hpp"
#include "kernel/run/random.hpp"

namespace millscope::run {
namespace {

using config::UserError;
using Point = std::array<double, 3>;

constexpr double kSpacing = 1.04;  // of the largest diameter: neighbouring sites, so that jitter leaves no overlap

struct Region {
  config::Box box;
  bool cylinder = false;
  double radius = 0;
  Point axis_point{};
};

/// Where beads may be put: what the user says, else the intersection of what the geometries call their inside.
Region region_of(const Assembly& a) {
  Region r;
  const double infinite = 1e300;
  r.box.low = {-infinite, -infinite, -infinite};
  r.box.high = {infinite, infinite, infinite};
  const auto narrow = [&r](std::size_t axis, double low, double high) {
    r.box.low[axis] = std::max(r.box.low[axis], low);
    r.box.high[axis] = std::min(r.box.high[axis], high);
  };
  for (const GeometryUse& g : a.geometries) {
    if (!g.interior.is_bounded || (a.c.fill.region && !g.interior.is_cylinder)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) narrow(axis, g.interior.low[axis], g.interior.high[axis]);
    if (g.interior.is_cylinder) {
      r.cylinder = true;
      r.radius = g.interior.radius;
      r.axis_point = {g.interior.axis_point[0], g.interior.axis_point[1], g.interior.axis_point[2]};
      narrow(0, r.axis_point[0] - r.radius, r.axis_point[0] + r.radius);
      narrow(1, r.axis_point[1] - r.radius, r.axis_point[1] + r.radius);
    }
  }
  if (a.c.fill.region) {
    for (std::size_t axis = 0; axis < 3; ++axis) narrow(axis, a.c.fill.region->low[axis], a.c.fill.region->high[axis]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.c.domain.periodic[axis]) {
      r.box.low[axis] = a.c.domain.box.low[axis];
      r.box.high[axis] = a.c.domain.box.high[axis];
    }
    if (!(r.box.high[axis] - r.box.low[axis] < 1e6)) {
      throw UserError(
          a.c.fill.where,
          fmt::format("nothing bounds the space to fill along {}; give fill.region: {{low: [x, y, z], high: [x, y, z]}}", "xyz"[axis]));
    }
  }
  return r;
}

/// Sites of a hexagonal close packing with neighbour distance `spacing`, stretched to fit a periodic axis z exactly.
std::vector<Point> sites_of(const Assembly& a, const Region& r, double diameter) {
  const double spacing = kSpacing * diameter;
  const auto periodic = [&a](std::size_t axis) { return a.c.domain.periodic[axis]; };
  // Rows along z (periodic in slices): row distance in y, layers in x are those of a hexagonal packing.
  const double extent[3] = {r.box.high[0] - r.box.low[0], r.box.high[1] - r.box.low[1], r.box.high[2] - r.box.low[2]};
  const double ideal[3] = {spacing * std::sqrt(2.0 / 3.0), spacing * std::sqrt(3.0) / 2, spacing};
  double step[3], origin[3];
  int count[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double usable = periodic(axis) ? extent[axis] : extent[axis] - diameter;
    const double cells = usable / ideal[axis];
    count[axis] = std::max(0, static_cast<int>(std::floor(cells))) + (periodic(axis) ? 0 : 1);
    // An even number of rows closes the stagger over a periodic boundary.
    if (periodic(axis) && axis != 2 && count[axis] % 2) --count[axis];
    step[axis] = periodic(axis) && count[axis] > 0 ? extent[axis] / count[axis] : ideal[axis];
    origin[axis] = r.box.low[axis] + (periodic(axis) ? 0.0 : 0.5 * diameter);
  }
  std::vector<Point> sites;
  for (int layer = 0; layer < count[0]; ++layer) {
    for (int row = 0; row < count[1]; ++row) {
      for (int k = 0; k < count[2]; ++k) {
        const double shift_z = 0.5 * ((row + layer) % 2) * step[2], shift_y = layer % 2 ? step[1] / 3 : 0.0;
        Point p{origin[0] + layer * step[0], origin[1] + row * step[1] + shift_y, origin[2] + k * step[2] + shift_z};
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (!periodic(axis)) inside = inside && p[axis] <= r.box.high[axis] - 0.5 * diameter;
        }
        if (r.cylinder) inside = inside && std::hypot(p[0] - r.axis_point[0], p[1] - r.axis_point[1]) <= r.radius - 0.5 * diameter;
        if (inside) sites.push_back(p);
      }
    }
  }
  return sites;
}

/// Marks the sites whose sphere touches a surface.
void mark_touching(const GeometryUse& g, const std::vector<Point>& sites, double radius, std::vector<std::uint8_t>& bad) {
  const std::size_t n = sites.size();
  std::vector<double> x(n), y(n), z(n), r(n, radius);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = sites[i][0];
    y[i] = sites[i][1];
    z[i] = sites[i][2];
  }
  std::vector<std::vector<std::uint32_t>> near(n);
  const CandidateSink sink{
      &near, [](void* host, std::int64_t bead, std::uint32_t feature) {
        (*static_cast<std::vector<std::vector<std::uint32_t>>*>(host))[static_cast<std::size_t>(bead)].push_back(feature);
      }};
  const GeometryBeads all{static_cast<std::int64_t>(n), {x.data(), y.data(), z.data()}, r.data()};
  Failure failure{};
  g.object.check(g.object.table().candidates(g.object.self(), &all, 0.0, &sink, &failure), failure);
  constexpr std::size_t kCapacity = 64;
  std::int32_t bead[kCapacity];
  double overlap[kCapacity], normal[3][kCapacity];
  std::uint32_t feature[kCapacity], triangle[kCapacity], material[kCapacity];
  for (std::size_t i = 0; i < n; ++i) {
    if (near[i].empty()) continue;
    const std::int64_t first[2] = {0, static_cast<std::int64_t>(near[i].size())};
    const GeometryQuery query{{1, {&x[i], &y[i], &z[i]}, &r[i]}, first, near[i].data(), 0.0};
    GeometryContacts found{kCapacity, 0, bead, overlap, {normal[0], normal[1], normal[2]}, feature, triangle, material};
    g.object.table().contacts(g.object.self(), &query, &found);
    if (found.count > 0) bad[i] = 1;
  }
}

/// Whether the segment p–q crosses the triangle (Möller & Trumbore 1997).
bool crosses(const Point& p, const Point& q, const double* a, const double* b, const double* c) {
  const auto minus = [](const double* u, const double* v) { return Point{u[0] - v[0], u[1] - v[1], u[2] - v[2]}; };
  const auto cross = [](const Point& u, const Point& v) {
    return Point{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  };
  const auto dot = [](const Point& u, const Point& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const Point d = minus(q.data(), p.data()), e1 = minus(b, a), e2 = minus(c, a);
  const Point h = cross(d, e2);
  const double det = dot(e1, h);
  if (std::abs(det) < 1e-300) return false;
  const Point s = minus(p.data(), a);
  const double u = dot(s, h) / det;
  if (u < 0 || u > 1) return false;
  const Point k = cross(s, e1);
  const double v = dot(d, k) / det, t = dot(e2, k) / det;
  return v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

/// Marks the sites that a surface separates from the axis of its own interior (inside a lifter, outside the shell).
void mark_hidden(const GeometryUse& g, const std::vector<Point>& sites, std::vector<std::uint8_t>& bad) {
  if (!g.interior.is_bounded || !g.interior.is_cylinder || g.surface.triangle_count == 0) return;
  const Point axis{g.interior.axis_point[0], g.interior.axis_point[1], g.interior.axis_point[2]};
  // Triangles sorted into angular sectors as seen from the axis: a radial segment meets those of its own sector only.
  constexpr std::size_t kSectors = 256;
  const auto angle = [&axis](const double* v) { return std::atan2(v[1] - axis[1], v[0] - axis[0]); };
  const auto sector = [](double phi) {
    return static_cast<std::ptrdiff_t>(std::floor((phi + std::numbers::pi) / (2 * std::numbers::pi) * static_cast<double>(kSectors)));
  };
  std::vector<std::vector<std::uint64_t>> bins(kSectors);
  for (std::uint64_t t = 0; t < g.surface.triangle_count; ++t) {
    const double* v[3];
    double low = 1e9, high = -1e9;
    for (std::uint64_t k = 0; k < 3; ++k) {
      v[k] = g.surface.vertices + 3 * static_cast<std::uint64_t>(g.surface.triangles[3 * t + k]);
      double phi = angle(v[k]);
      if (k > 0 && phi - low > std::numbers::pi) phi -= 2 * std::numbers::pi;
      if (k > 0 && low - phi > std::numbers::pi) phi += 2 * std::numbers::pi;
      low = std::min(low, phi);
      high = std::max(high, phi);
    }
    // A face across the axis (an end wall) may be met from anywhere; it is found by the touching test and the box.
    if (high - low > 2.5) continue;
    for (std::ptrdiff_t s = sector(low); s <= sector(high); ++s)
      bins[static_cast<std::size_t>((s + 2 * static_cast<std::ptrdiff_t>(kSectors)) % static_cast<std::ptrdiff_t>(kSectors))].push_back(t);
  }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (bad[i]) continue;
    const std::size_t s = static_cast<std::size_t>((sector(angle(sites[i].data())) + static_cast<std::ptrdiff_t>(kSectors)) %
                                                   static_cast<std::ptrdiff_t>(kSectors));
    const Point target{axis[0], axis[1], sites[i][2]};
    for (const std::uint64_t t : bins[s]) {
      const auto vertex = [&](std::uint64_t k) {
        return g.surface.vertices + 3 * static_cast<std::uint64_t>(g.surface.triangles[3 * t + k]);
      };
      if (crosses(sites[i], target, vertex(0), vertex(1), vertex(2))) {
        bad[i] = 1;
        break;
      }
    }
  }
}

struct BeadType {
  std::size_t bead_class;
  double diameter;
};

/// How many of each class and size: largest remainders, so that the numbers add up and no seed changes them; then shuffled.
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
  for (std::size_t i = types.size(); i > 1; --i) std::swap(types[i - 1], types[random.below(i)]);
  return types;
}

}  // namespace

void insert_beads(Assembly& a) {
  Random random(a.c.seed);
  const double diameter = a.c.largest_diameter();
  const Region region = region_of(a);
  std::vector<Point> sites = sites_of(a, region, diameter);
  std::vector<std::uint8_t> bad(sites.size(), 0);
  const double jitter = 0.25 * (kSpacing - 1) * diameter;
  for (const GeometryUse& g : a.geometries) {
    mark_touching(g, sites, 0.5 * diameter + 2 * jitter, bad);
    mark_hidden(g, sites, bad);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (!bad[i]) sites[kept++] = sites[i];
  }
  sites.resize(kept);
  if (sites.size() < a.bead_count) {
    throw UserError(a.c.fill.where,
                    fmt::format("{} beads are asked for but only {} fit without touching; lower the filling, or check that the liner is in "
                                "the right unit (millscope geometry report)",
                                a.bead_count, sites.size()));
  }
  // Lowest first, against gravity; ties by position so that the choice is the same everywhere.
  const auto height = [&a](const Point& p) { return -(p[0] * a.gravity[0] + p[1] * a.gravity[1] + p[2] * a.gravity[2]); };
  std::sort(sites.begin(), sites.end(), [&height](const Point& p, const Point& q) {
    const double hp = height(p), hq = height(q);
    return hp != hq ? hp < hq : p < q;
  });
  sites.resize(a.bead_count);
  const std::vector<BeadType> types = draw_types(a, a.bead_count, random);
  dem::Particles& p = a.system->particles;
  p.resize(a.bead_count);
  for (std::size_t i = 0; i < a.bead_count; ++i) {
    const config::BeadCase& bead = a.c.beads[types[i].bead_class];
    const double radius = 0.5 * types[i].diameter;
    const double mass = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * bead.density;
    const auto shake = [&random, jitter] { return jitter * (2 * random.uniform() - 1) / std::numbers::sqrt3; };
    p.position[i] = {sites[i][0] + shake(), sites[i][1] + shake(), sites[i][2] + shake(), radius};
    dem::MotionLine line{};
    line.inverse_mass = 1 / mass;
    line.inverse_inertia = 1 / (0.4 * mass * radius * radius);
    p.motion[i] = p.half[i] = line;
    p.force[i] = dem::ForceLine{};
    p.acceleration[i] = dem::AccelerationLine{};
    p.id[i] = static_cast<std::uint32_t>(i);
    p.material[i] = static_cast<std::uint8_t>(std::find(a.materials.begin(), a.materials.end(), bead.material) - a.materials.begin());
  }
}

}  // namespace millscope::run
