// A geometry with its surface, asked bead by bead: what the checks of a geometry are made of.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "millscope/conformance/values.hpp"
#include "millscope/element.hpp"
#include "millscope/geometry.hpp"
#include "millscope/pack.hpp"

namespace millscope::conformance {

using Point = Vec<double>;

/// A bead that may touch the wall.
struct ProbeBead {
  Point position;
  double radius;
};

/// One place that it touches.
struct Touch {
  std::int64_t bead;
  double overlap;
  Point normal;
  std::uint32_t feature, triangle, material;
};

class WallProbe {
 public:
  WallProbe(const GeometryTable& table, const Values& values) : held_(table, values) {
    table.surface(held_.get(), &surface_);
    table.interior(held_.get(), &interior_);
  }

  const Surface& surface() const { return surface_; }
  const Interior& interior() const { return interior_; }
  std::string slots() const { return held_.table().material_slots(held_.get()); }
  std::string report() const { return held_.table().report(held_.get()); }

  Point vertex(std::uint32_t i) const { return {surface_.vertices[3 * i], surface_.vertices[3 * i + 1], surface_.vertices[3 * i + 2]}; }
  std::array<Point, 3> triangle(std::uint64_t t) const {
    const std::uint32_t* corner = surface_.triangles + 3 * t;
    return {vertex(corner[0]), vertex(corner[1]), vertex(corner[2])};
  }

  /// Whether the host asks which triangles are touched; where it does not, they come as kNoTriangle.
  bool asks_for_triangles = true;

  /// Contacts and gaps up to `reach` of the beads, with the candidates found with `margin`; at most `capacity`, which
  /// without a number is what the host keeps.
  std::vector<Touch> touches(const std::vector<ProbeBead>& beads, double margin, double reach, std::optional<std::size_t> capacity = {}) {
    std::vector<double> x[3], radius;
    for (const ProbeBead& bead : beads) {
      x[0].push_back(bead.position.x), x[1].push_back(bead.position.y), x[2].push_back(bead.position.z);
      radius.push_back(bead.radius);
    }
    const GeometryBeads view{static_cast<std::int64_t>(beads.size()), {x[0].data(), x[1].data(), x[2].data()}, radius.data()};
    std::vector<std::vector<std::uint32_t>> found(beads.size());
    const CandidateSink sink{&found, [](void* host, std::int64_t bead, std::uint32_t feature) {
                               element(*static_cast<std::vector<std::vector<std::uint32_t>>*>(host), bead).push_back(feature);
                             }};
    Failure failure{};
    if (held_.table().candidates(held_.get(), &view, margin, &sink, &failure) != 0) throw Refusal(failure.message);
    std::vector<std::int64_t> first{0};
    std::vector<std::uint32_t> candidates;
    for (const std::vector<std::uint32_t>& of_bead : found) {
      candidates.insert(candidates.end(), of_bead.begin(), of_bead.end());
      first.push_back(static_cast<std::int64_t>(candidates.size()));
    }
    return contacts({view, first.data(), candidates.data(), reach}, capacity.value_or(beads.size() * kMaxWallContacts));
  }

 private:
  std::vector<Touch> contacts(const GeometryQuery& query, std::size_t capacity) const {
    const std::size_t room = std::max<std::size_t>(capacity, 1);
    std::vector<std::int32_t> bead(room);
    std::vector<double> overlap(room), normal[3] = {overlap, overlap, overlap};
    std::vector<std::uint32_t> feature(room), triangle(room, kNoTriangle), material(room);
    GeometryContacts out{static_cast<std::int64_t>(capacity),
                         0,
                         bead.data(),
                         overlap.data(),
                         {normal[0].data(), normal[1].data(), normal[2].data()},
                         feature.data(),
                         asks_for_triangles ? triangle.data() : nullptr,
                         material.data()};
    held_.table().contacts(held_.get(), &query, &out);
    if (out.count < 0 || out.count > out.capacity) throw Refusal("contacts: more are counted than there was room for");
    std::vector<Touch> touches;
    for (std::size_t i = 0; i < as_size(out.count); ++i) {
      touches.push_back({bead[i], overlap[i], {normal[0][i], normal[1][i], normal[2][i]}, feature[i], triangle[i], material[i]});
    }
    return touches;
  }

  Held<GeometryTable> held_;
  Surface surface_{};
  Interior interior_{};
};

/// Nearest point of a triangle (Ericson 2005, section 5.1.5).
inline Point nearest_point(const Point& p, const std::array<Point, 3>& t) {
  const Point ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return t[0];
  if (d3 >= 0 && d4 <= d3) return t[1];
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + (d1 / (d1 - d3)) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + (d2 / (d2 - d6)) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return t[1] + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]);
  const double whole = 1.0 / (va + vb + vc);
  return t[0] + (vb * whole) * ab + (vc * whole) * ac;
}

/// How far a point is from the triangles, and whether it lies on the beads' side of all that are nearest.
struct SurfaceDistance {
  double distance;
  bool inside;
};

inline SurfaceDistance distance_to_surface(const WallProbe& wall, const Point& p) {
  double least = HUGE_VAL;
  std::vector<double> distance, side;
  for (std::uint64_t t = 0; t < wall.surface().triangle_count; ++t) {
    const std::array<Point, 3> corners = wall.triangle(t);
    const Point away = p - nearest_point(p, corners);
    distance.push_back(length(away));
    side.push_back(dot(away, cross(corners[1] - corners[0], corners[2] - corners[0])));
    least = std::min(least, distance.back());
  }
  bool inside = true;
  for (std::size_t t = 0; t < distance.size(); ++t) inside = inside && (distance[t] > least * (1.0 + 1e-9) + 1e-12 || side[t] > 0.0);
  return {least, inside};
}

}  // namespace millscope::conformance
