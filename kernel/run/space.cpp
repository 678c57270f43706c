#include "kernel/run/space.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::run {
namespace {

using base::UserError;

/// Marks the sites whose sphere touches a surface.
void mark_touching(const GeometryUse& g, const std::vector<base::Vector3>& sites, std::vector<double> r, std::vector<std::uint8_t>& bad) {
  const std::size_t n = sites.size();
  std::vector<double> x(n), y(n), z(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = sites[i][0];
    y[i] = sites[i][1];
    z[i] = sites[i][2];
  }
  std::vector<std::vector<std::uint32_t>> near(n);
  const CandidateSink sink{&near, [](void* host, std::int64_t bead, std::uint32_t feature) {
                             (*static_cast<std::vector<std::vector<std::uint32_t>>*>(host))[bead].push_back(feature);
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
bool crosses(const base::Vector3& p, const base::Vector3& q, const double* a, const double* b, const double* c) {
  const auto minus = [](const double* u, const double* v) { return base::Vector3{u[0] - v[0], u[1] - v[1], u[2] - v[2]}; };
  using base::cross;
  using base::dot;
  const base::Vector3 d = minus(q.data(), p.data()), e1 = minus(b, a), e2 = minus(c, a);
  const base::Vector3 h = cross(d, e2);
  const double det = dot(e1, h);
  if (std::abs(det) < 1e-300) return false;
  const base::Vector3 s = minus(p.data(), a);
  const double u = dot(s, h) / det;
  if (u < 0 || u > 1) return false;
  const base::Vector3 k = cross(s, e1);
  const double v = dot(d, k) / det, t = dot(e2, k) / det;
  return v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

/// Marks the sites that a surface separates from the axis of its own interior (inside a lifter, outside the shell).
void mark_hidden(const GeometryUse& g, const std::vector<base::Vector3>& sites, std::vector<std::uint8_t>& bad) {
  if (!g.interior.is_bounded || !g.interior.is_cylinder || g.surface.triangle_count == 0) return;
  const base::Vector3 axis{g.interior.axis_point[0], g.interior.axis_point[1], g.interior.axis_point[2]};
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
      bins[(s + 2 * static_cast<std::ptrdiff_t>(kSectors)) % static_cast<std::ptrdiff_t>(kSectors)].push_back(t);
  }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (bad[i]) continue;
    const std::ptrdiff_t s =
        (sector(angle(sites[i].data())) + static_cast<std::ptrdiff_t>(kSectors)) % static_cast<std::ptrdiff_t>(kSectors);
    const base::Vector3 target{axis[0], axis[1], sites[i][2]};
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

/// Points as a geometry sees them when the run begins.
std::vector<base::Vector3> in_frame_of(const Assembly& a, std::size_t geometry, const std::vector<base::Vector3>& points) {
  const dem::Pose pose = dem::pose_at(a.system->bodies[geometry].motion, static_cast<double>(a.first_step) * a.time_step);
  std::vector<base::Vector3> turned(points.size(), base::Vector3{});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t row = 0; row < 3; ++row) turned[i][k] += pose.rotation[row][k] * (points[i][row] - pose.offset[row]);
    }
  }
  return turned;
}

}  // namespace

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

double height(const Assembly& a, const base::Vector3& p) { return -base::dot(p, a.gravity); }

double level(const Assembly& a, const Region& r, double part) {
  double low = 0, high = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double one = -a.gravity[axis] * r.box.low[axis], other = -a.gravity[axis] * r.box.high[axis];
    low += std::min(one, other);
    high += std::max(one, other);
  }
  return part >= 1 ? 1e300 : low + part * (high - low);
}

double first_part(const Assembly& a, const Region& r, double volume) {
  if (a.gravity == std::array<double, 3>{}) return 1;
  double all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) all *= r.box.high[axis] - r.box.low[axis];
  return std::min(1.0, volume / all);
}

std::vector<std::uint8_t> blocked(const Assembly& a, const std::vector<base::Vector3>& centres, double radius) {
  return blocked(a, centres, std::vector<double>(centres.size(), radius));
}

std::vector<std::uint8_t> blocked(const Assembly& a, const std::vector<base::Vector3>& centres, const std::vector<double>& radii) {
  std::vector<std::uint8_t> bad(centres.size(), 0);
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const std::vector<base::Vector3> sites = in_frame_of(a, g, centres);
    mark_touching(a.geometries[g], sites, radii, bad);
    mark_hidden(a.geometries[g], sites, bad);
  }
  return bad;
}

}  // namespace millscope::run
