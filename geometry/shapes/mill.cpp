#include "geometry/shapes/mill.hpp"
#include "millscope/element.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace millscope::geometry {

namespace {

// Candidates of a mill name what is near: the outline or one of the ends.
constexpr std::uint32_t kOutline = 0, kLowEnd = 1, kHighEnd = 2;
constexpr std::uint32_t kNoTriangle = 0xffffffffU;
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
    if (safe <= 0 || x * x + y * y > safe * safe) sink.add(sink.host, i, kOutline);
    if (!slots_.end) continue;
    if (z < reach) sink.add(sink.host, i, kLowEnd);
    if (z > length - reach) sink.add(sink.host, i, kHighEnd);
  }
}

/// Shell of each bay, then three faces of each lifter; the corners belong to the top.
std::uint32_t Mill::feature_of(const ProfileContact& c) const {
  const int bays = std::max(1, profile_.shape().lifters);
  if (c.piece == Piece::shell) return static_cast<std::uint32_t>(c.sector);
  return static_cast<std::uint32_t>(bays + 3 * c.sector + static_cast<int>(c.piece));
}

void Mill::touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const {
  const Point& p = bead.position;
  const auto ends = static_cast<std::uint32_t>(4 * std::max(1, profile_.shape().lifters));
  for (std::size_t i = 0; i < count; ++i) {
    if (candidates[i] == kOutline) {
      ProfileContact found[kMaxProfileContacts];
      const int n = profile_.touch({p.x, p.y}, bead.radius, bead.reach, found);
      for (int k = 0; k < n; ++k) {
        const ProfileContact& c = found[k];
        const std::uint32_t slot = c.piece == Piece::shell ? slots_.shell : *slots_.lifter;
        out.add({c.overlap, {c.normal[0], c.normal[1], 0}, feature_of(c), surface_->triangle_at(c, p.z), slot});
      }
    } else if (candidates[i] == kLowEnd) {
      out.add({bead.radius - p.z, {0, 0, 1}, ends, kNoTriangle, *slots_.end});
    } else {
      out.add({bead.radius - (profile_.shape().length - p.z), {0, 0, -1}, ends + 1, kNoTriangle, *slots_.end});
    }
  }
}

}  // namespace millscope::geometry
