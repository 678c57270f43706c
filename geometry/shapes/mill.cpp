#include "geometry/shapes/mill.hpp"
#include "millscope/element.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace millscope::geometry {

namespace {

constexpr double kMaxTriangles = 20e6;  // of the tessellation: about 1 GB

std::string details(const MillProfile& profile) {
  const MillShape& s = profile.shape();
  const double bare = std::numbers::pi * s.radius * s.radius;
  char text[512];
  int used = std::snprintf(text, sizeof text, "shell: radius %.6g m, length %.6g m, bare volume %.6g m^3\nends: %s\n", s.radius, s.length,
                           bare * s.length, s.end_faces ? "closed" : "open (the wall goes on along z)");
  if (s.lifters > 0) {
    std::snprintf(text + used, sizeof text - as_size(used),
                  "lifters: %d, height %.6g m, width %.6g m at the base and %.6g m at the top, face angle %.6g rad\n"
                  "lifter volume: %.6g m^3 (%.3g %% of the bare shell; J is counted on the bare shell)\n",
                  s.lifters, s.lifter_height, s.lifter_width, 2 * profile.top_half_width(), s.face_angle, profile.lifter_area() * s.length,
                  100 * profile.lifter_area() / bare);
  }
  return text;
}

}  // namespace

MillShape Mill::mill_shape(const Parameters& p) {
  MillShape s;
  s.radius = 0.5 * p.number("diameter");
  s.length = p.number("length");
  s.lifters = static_cast<int>(p.integer("lifters"));
  s.lifter_height = p.number("lifter_height");
  s.lifter_width = p.number("lifter_width");
  s.face_angle = p.number("lifter_face_angle");
  s.phase = p.number("phase");
  s.end_faces = p.flag("end_faces");
  if (s.lifters > 0 && !(s.lifter_height > 0 && s.lifter_width > 0)) {
    throw Refusal("mill: " + std::to_string(s.lifters) +
                  " lifters need lifter_height and lifter_width above 0 m; write lifters: 0 for a smooth shell");
  }
  return s;
}

MillShape Mill::cylinder_shape(const Parameters& p) {
  MillShape s;
  s.radius = p.number("radius");
  s.length = p.number("length");
  s.end_faces = p.flag("end_faces");
  return s;
}

Mill::Mill(const char* kind, const MillShape& shape, double facet, int rows) : profile_(shape), slot_names_("shell") {
  const double outline = 2 * std::numbers::pi * shape.radius + 4.0 * shape.lifters * shape.lifter_height;
  if (2 * rows * outline / facet > kMaxTriangles) {
    throw Refusal(std::string(kind) + ": facet " + std::to_string(facet) + " m with axial_cuts " + std::to_string(rows) +
                  " makes more than 20 million triangles: give a longer facet (0.003 m suits a mill of 0.3 m)");
  }
  std::uint32_t next = 1;
  if (shape.lifters > 0) slots_.lifter = next++, slot_names_ += "|lifter";
  if (shape.end_faces) slots_.end = next++, slot_names_ += "|end";
  surface_ = std::make_unique<MillSurface>(profile_, slots_, facet, rows);
  report_ = shape_report(kind, surface(), details(profile_));
}

Interior Mill::interior() const {
  const MillShape& s = profile_.shape();
  return {1, 1, {0, 0, 0}, {0, 0, 1}, s.radius, {-s.radius, -s.radius, 0}, {s.radius, s.radius, s.length}};
}

void Mill::candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const {
  const double free = profile_.free_radius(), length = profile_.shape().length;
  for (std::int64_t i = 0; i < beads.count; ++i) {
    const double x = beads.position[0][i], y = beads.position[1][i], z = beads.position[2][i], reach = beads.radius[i] + margin;
    const double safe = free - reach;
    const auto add = [&](std::uint32_t candidate) { sink.add(sink.host, i, candidate); };
    if (safe <= 0 || x * x + y * y > safe * safe) {
      profile_.near_bays(x, y, reach, [&](int k) { add(static_cast<std::uint32_t>(k)); });
      profile_.near_lifters(x, y, reach, [&](int k) { add(bay_count() + static_cast<std::uint32_t>(k)); });
    }
    if (!slots_.end) continue;
    if (z < reach) add(low_end());
    if (z > length - reach) add(low_end() + 1);
  }
}

void Mill::add(Neighbours& n, const GeometryQuery& query, std::int64_t bead, std::uint32_t candidate) const {
  const int at = n.count++;
  const double x = query.beads.position[0][bead], y = query.beads.position[1][bead];
  n.bead[at] = bead;
  n.candidate[at] = candidate;
  n.radius[at] = query.beads.radius[bead];
  const bool bay = is_bay(candidate), lifter = !bay && candidate < low_end();
  const ProfileFrame frame = bay      ? profile_.bay(static_cast<int>(candidate))
                             : lifter ? profile_.lifter(static_cast<int>(candidate - bay_count()))
                                      : ProfileFrame{1, 0};
  n.u[at] = x * frame.cosine + y * frame.sine;
  n.v[at] = y * frame.cosine - x * frame.sine;
}

/// The last of them again, up to a whole number of packs.
void Mill::pad(Neighbours& n) {
  for (int k = n.count; k % kLanes != 0; ++k) {
    n.candidate[k] = n.candidate[k - 1];
    n.u[k] = n.u[k - 1];
    n.v[k] = n.v[k - 1];
    n.radius[k] = n.radius[k - 1];
  }
}

void Mill::keep(const Neighbours& n, const GeometryQuery& query, GeometryContacts& out) const {
  for (int k = 0; k < n.count; ++k) {
    const std::int64_t first = out.count - kMaxWallContacts;  // beads come in order
    if (first >= 0 && out.bead[first] == n.bead[k]) continue;
    if (n.candidate[k] >= low_end()) {
      keep_end(n, k, query, out);
    } else if (n.overlap[k] > -query.reach) {
      keep_outline(n, k, query, out);
    }
  }
}

void Mill::keep_end(const Neighbours& n, int at, const GeometryQuery& query, GeometryContacts& out) const {
  const bool low = n.candidate[at] == low_end();
  const double z = query.beads.position[2][n.bead[at]], overlap = n.radius[at] - (low ? z : profile_.shape().length - z);
  if (!(overlap > -query.reach)) return;
  const auto ends = static_cast<std::uint32_t>(4 * profile_.bays());
  append_contact({overlap, {0, 0, low ? 1.0 : -1.0}, low ? ends : ends + 1, kNoTriangle, *slots_.end}, n.bead[at], &out);
}

/// Features: the shell of each bay, then three faces of each lifter; the corners belong to the top.
void Mill::keep_outline(const Neighbours& n, int at, const GeometryQuery& query, GeometryContacts& out) const {
  const std::uint32_t candidate = n.candidate[at];
  const bool shell = is_bay(candidate);
  const int k = static_cast<int>(shell ? candidate : candidate - bay_count());
  const auto piece = static_cast<Piece>(static_cast<int>(n.piece[at]));
  const ProfileFrame& frame = shell ? profile_.bay(k) : profile_.lifter(k);
  const double u = n.normal_u[at], v = n.normal_v[at];
  const Point normal{u * frame.cosine - v * frame.sine, u * frame.sine + v * frame.cosine, 0};
  const std::uint32_t feature = shell ? candidate : bay_count() + static_cast<std::uint32_t>(3 * k + static_cast<int>(piece));
  std::uint32_t triangle = kNoTriangle;
  if (out.triangle != nullptr) {
    const ProfilePlace place = shell ? profile_.place_on_shell(k, n.u[at], n.v[at]) : profile_.place_on_lifter(k, n.u[at], n.v[at], piece);
    triangle = surface_->triangle_at(place, query.beads.position[2][n.bead[at]]);
  }
  append_contact({n.overlap[at], normal, feature, triangle, shell ? slots_.shell : *slots_.lifter}, n.bead[at], &out);
}

}  // namespace millscope::geometry
