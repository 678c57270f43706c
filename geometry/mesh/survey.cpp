#include "geometry/mesh/survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

constexpr int kLooks = 3600;  // directions round the axis
constexpr int kLevels = 5;    // heights along it

/// Where a plane z = level cuts a triangle: two points, or false.
bool cut(const IndexedMesh& mesh, std::size_t t, double level, Point (&ends)[2]) {
  int found = 0;
  for (std::size_t k = 0; k < 3 && found < 2; ++k) {
    const Point a = mesh.vertex(t, k), b = mesh.vertex(t, (k + 1) % 3);
    if ((a.z < level) == (b.z < level)) continue;
    ends[found++] = a + ((level - a.z) / (b.z - a.z)) * (b - a);
  }
  return found == 2;
}

void look_at(const Point (&ends)[2], std::vector<double>& nearest) {
  double from = std::atan2(ends[0].y, ends[0].x), to = std::atan2(ends[1].y, ends[1].x);
  if (from > to) std::swap(from, to);
  const double full = 2 * std::numbers::pi, step = full / kLooks;
  if (to - from > std::numbers::pi) {  // across the negative x axis
    std::swap(from, to);
    to += full;
  }
  const double edge_x = ends[1].x - ends[0].x, edge_y = ends[1].y - ends[0].y, moment = ends[0].x * edge_y - ends[0].y * edge_x;
  for (auto i = static_cast<long>(std::ceil(from / step)); static_cast<double>(i) * step <= to; ++i) {
    const double angle = static_cast<double>(i) * step, across = std::cos(angle) * edge_y - std::sin(angle) * edge_x;
    if (across == 0) continue;
    double& seen = element(nearest, ((i % kLooks) + kLooks) % kLooks);
    seen = std::min(seen, std::fabs(moment / across));
  }
}

/// How much of a triangle looks inwards: 1 or 0 of a wall, by the way to the axis, and of an end face, by the way to the middle; 0 of both
/// where it looks along neither, as the side of a lifter does.
struct Look {
  double inward = 0, judged = 0;
};

Look look_of(const Point& normal, const Point& out, const Axis& axis) {
  if (!axis.found) return {dot(normal, out) < 0 ? 1.0 : 0.0, 1};
  const Point& d = axis.direction;
  const double along = dot(out, d), up = dot(normal, d);
  const Point across = out - along * d;
  const double reach = length(across), radial = reach > 0 ? dot(normal, across) / reach : 0;
  const double round = std::sqrt(std::max(0.0, dot(normal, normal) - up * up - radial * radial));
  if (round > std::max(std::fabs(up), std::fabs(radial))) return {};
  return {(std::fabs(up) > std::fabs(radial) ? up * along : radial) < 0 ? 1.0 : 0.0, 1};
}

void add_up(const IndexedMesh& mesh, Survey& s) {
  double inward = 0, judged = 0;
  const Point middle = s.axis.found ? s.axis.point : 0.5 * (s.box.low + s.box.high);
  for (std::size_t t = 0; t < mesh.own; ++t) {
    const Point a = mesh.vertex(t, 0), normal = double_area(mesh, t);
    const Point out = (1.0 / 3) * (a + mesh.vertex(t, 1) + mesh.vertex(t, 2)) - middle;
    const double area = 0.5 * length(normal);
    const Look look = look_of(normal, out, s.axis);
    s.area += area;
    s.volume += dot(normal, a - middle) / 6;
    inward += look.inward * area, judged += look.judged * area;
  }
  s.inward_share = judged > 0 ? inward / judged : 0;
}

Facing facing_of(const Survey& s, const Topology& topology) {
  if (topology.turned_edges > 0) return Facing::mixed;
  if (s.closed) return s.volume > 0 ? Facing::outwards : Facing::inwards;
  if (s.inward_share > 0.8) return Facing::inwards;
  return s.inward_share < 0.2 ? Facing::outwards : Facing::both;
}

Interior interior_of(const IndexedMesh& mesh, const Survey& s) {
  Interior in{0, 1, {0, 0, 0}, {0, 0, 1}, 0, {s.box.low.x, s.box.low.y, s.box.low.z}, {s.box.high.x, s.box.high.y, s.box.high.z}};
  const double size = s.box.diagonal();
  const bool round_z = s.axis.found && s.axis.direction.z == 1 && std::hypot(s.axis.point.x, s.axis.point.y) < 0.01 * size;
  const double radius = round_z ? bare_radius(mesh, s.box) : 0;
  if (!(radius > 0)) return in;
  double outermost = 0;
  for (const Point& p : mesh.vertices) outermost = std::max(outermost, std::hypot(p.x, p.y));
  in.is_cylinder = 1;
  in.radius = outermost - radius < 1e-3 * outermost ? outermost : radius;  // chords see the true radius only at their ends
  return in;
}

const char* facing_text(Facing f) {
  switch (f) {
    case Facing::inwards:
      return "facing inwards";
    case Facing::outwards:
      return "facing outwards";
    case Facing::both:
      return "facing both ways";
    case Facing::mixed:
      return "mixed: neighbours are wound against each other";
  }
  return "";
}

std::string format(const char* pattern, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string axis_text(const Axis& axis) {
  if (!axis.found) return "axis: none found\n";
  const Point &d = axis.direction, &p = axis.point;
  const char* name = d.x == 1 ? "x" : d.y == 1 ? "y" : d.z == 1 ? "z" : "";
  const std::string direction = *name ? name : format("[%.5f, %.5f, %.5f]", d.x, d.y, d.z);
  return format("axis: %s through [%.6g, %.6g, %.6g] m, asymmetry %.2g\n", direction.c_str(), p.x, p.y, p.z, axis.asymmetry);
}

/// Rounding leaves about 1e-17 where a coordinate should be zero.
Point cleaned(const Point& p, double size) {
  const auto clean = [size](double x) { return std::fabs(x) < 1e-9 * size ? 0.0 : x; };
  return {clean(p.x), clean(p.y), clean(p.z)};
}

}  // namespace

double bare_radius(const IndexedMesh& mesh, const Bounds& box) {
  double radius = 0;
  int met = 0;
  for (int level = 0; level < kLevels; ++level) {
    // An odd fraction: vertices of regular meshes do not lie exactly there.
    const double z = box.low.z + (box.high.z - box.low.z) * (level + 0.4937) / kLevels;
    std::vector<double> nearest(kLooks, std::numeric_limits<double>::infinity());
    Point ends[2];
    for (std::size_t t = 0; t < mesh.own; ++t) {
      if (cut(mesh, t, z, ends)) look_at(ends, nearest);
    }
    for (const double r : nearest) {
      if (!std::isfinite(r)) continue;
      radius = std::max(radius, r);
      ++met;
    }
  }
  return met > kLooks * kLevels / 2 ? radius : 0;
}

Survey survey_mesh(const IndexedMesh& mesh, const Topology& topology) {
  Survey s;
  Soup soup;
  for (std::size_t t = 0; t < mesh.own; ++t) {
    for (std::size_t k = 0; k < 3; ++k) soup.corners.push_back(mesh.vertex(t, k));
  }
  soup.slots.assign(mesh.own, 0);
  s.box = bounds_of(soup.corners);
  s.closed = topology.open_edges == 0 && topology.crowded_edges == 0;
  s.axis = find_axis(soup);
  s.axis.point = cleaned(s.axis.point, s.box.diagonal());
  add_up(mesh, s);
  if (s.closed && topology.turned_edges == 0) s.inward_share = s.volume < 0 ? 1 : 0;  // wound as one: lifters' sides too
  s.facing = facing_of(s, topology);
  s.interior = interior_of(mesh, s);
  return s;
}

std::string survey_text(const Survey& s, const IndexedMesh& mesh, const Topology& topology, const std::vector<std::string>& names) {
  std::string solids;
  for (const std::string& name : names) solids += (solids.empty() ? "" : ", ") + name;
  std::string text = format("triangles: %zu\nvertices: %zu\n", mesh.own, mesh.vertices.size());
  const Point &l = s.box.low, &h = s.box.high;
  text += format("box: [%.6g, %.6g, %.6g] to [%.6g, %.6g, %.6g] m\narea: %.6g m^2\n", l.x, l.y, l.z, h.x, h.y, h.z, s.area);
  text += s.closed ? format("surface: closed, volume %.6g m^3\n", std::fabs(s.volume)) : std::string("surface: open\n");
  text += format("open edges: %zu\nedges of three or more triangles: %zu\n", topology.open_edges, topology.crowded_edges);
  text += format("degenerate triangles: %zu dropped\nduplicate triangles: %zu dropped\n", mesh.degenerate, mesh.duplicate);
  text += format("orientation: %s (%.0f %% of the area inwards; contact is two-sided)\n", facing_text(s.facing), 100 * s.inward_share);
  text += format("solids: %zu (", names.size()) + solids + ")\n";
  text += format("connected parts: %u\nsmooth patches: %u\n", topology.parts, topology.patches);
  text += axis_text(s.axis);
  text += s.interior.is_cylinder ? format("interior: cylinder of radius %.6g m\n", s.interior.radius) : std::string("interior: the box\n");
  return text;
}

}  // namespace millscope::geometry
