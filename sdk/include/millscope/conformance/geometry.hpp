// What every geometry must hold to.
#pragma once

#include "millscope/conformance/wall.hpp"

namespace millscope::conformance {

/// What the checks of a geometry assume. Lengths of 0 follow from the size of its surface.
struct GeometrySetting {
  double bead_radius = 0.0;        ///< m; 0: 1/40 of the surface's longest side
  double surface_tolerance = 0.0;  ///< m; how far the triangles may be from the exact wall; 0: 1/200 of that side
  std::size_t bead_count = 300;
};

namespace detail {

/// Beads near the wall, on its right side, and the lengths of the setting.
struct WallSample {
  std::vector<ProbeBead> beads;
  double radius = 0, tolerance = 0;
};

inline std::uint32_t slot_count(const WallProbe& wall) {
  const std::string slots = wall.slots();
  return static_cast<std::uint32_t>(std::count(slots.begin(), slots.end(), '|')) + 1;
}

inline bool surface_is_sound(const WallProbe& wall, Violations& out) {
  const Surface& s = wall.surface();
  if (s.triangle_count == 0) return out.push_back({"surface", "there is no triangle to draw"}), false;
  for (std::uint64_t i = 0; i < 3 * s.vertex_count; ++i) {
    if (!std::isfinite(s.vertices[i]))
      return out.push_back({"surface", text_of("vertex %g is not finite (%g)", static_cast<double>(i / 3), s.vertices[i])}), false;
  }
  for (std::uint64_t i = 0; i < 3 * s.triangle_count; ++i) {
    if (s.triangles[i] >= s.vertex_count)
      return out.push_back({"surface", text_of("triangle %g names the vertex %g", static_cast<double>(i / 3), s.triangles[i])}), false;
  }
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    if (s.triangle_materials[t] >= slot_count(wall))
      return out.push_back({"material slots", text_of("triangle %g has the slot %g", static_cast<double>(t), s.triangle_materials[t])}),
             false;
  }
  const Interior& in = wall.interior();
  for (int axis = 0; axis < 3 && in.is_bounded != 0 && in.is_cylinder == 0; ++axis) {
    if (!(in.low[axis] < in.high[axis])) out.push_back({"interior", text_of("its bounds are %g m to %g m", in.low[axis], in.high[axis])});
  }
  if (in.is_cylinder != 0 && !(in.radius > 0.0 && in.low[2] < in.high[2]))
    out.push_back({"interior", text_of("its cylinder has the radius %g m and begins at %g m", in.radius, in.low[2])});
  return true;
}

/// Puts beads over places of the triangles, from half a radius deep to half a radius away. Kept are those whose centre is on the beads'
/// side of all that is near.
inline WallSample sample_wall(const WallProbe& wall, const GeometrySetting& setting) {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, side = 0;
  for (std::uint64_t i = 0; i < 3 * wall.surface().vertex_count; ++i) {
    low[i % 3] = std::min(low[i % 3], wall.surface().vertices[i]);
    high[i % 3] = std::max(high[i % 3], wall.surface().vertices[i]);
  }
  for (int axis = 0; axis < 3; ++axis) side = std::max(side, high[axis] - low[axis]);
  WallSample sample;
  sample.radius = setting.bead_radius > 0.0 ? setting.bead_radius : side / 40.0;
  sample.tolerance = setting.surface_tolerance > 0.0 ? setting.surface_tolerance : side / 200.0;
  Random numbers(5);
  for (std::size_t tries = 0; tries < 20 * setting.bead_count && sample.beads.size() < setting.bead_count; ++tries) {
    const auto t = static_cast<std::uint64_t>(numbers.between(0, static_cast<double>(wall.surface().triangle_count)));
    const std::array<Point, 3> c = wall.triangle(std::min(t, wall.surface().triangle_count - 1));
    const double u = numbers.between(0.05, 0.9), v = numbers.between(0.05, 0.95 - u);
    const Point across = cross(c[1] - c[0], c[2] - c[0]), place = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
    const Point centre = place + (sample.radius * numbers.between(0.5, 1.5) / length(across)) * across;
    const SurfaceDistance found = distance_to_surface(wall, centre);
    if (found.inside && found.distance > 0.3 * sample.radius) sample.beads.push_back({centre, sample.radius});
  }
  return sample;
}

/// The deepest of the touches; nullptr where there is none.
inline const Touch* deepest(const std::vector<Touch>& touches) {
  const auto found = std::max_element(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) { return a.overlap < b.overlap; });
  return found == touches.end() ? nullptr : &*found;
}

inline bool same_touches(const std::vector<Touch>& a, const std::vector<Touch>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Touch& p, const Touch& q) {
    const Point off = p.normal - q.normal;
    return p.bead == q.bead && p.feature == q.feature && p.material == q.material && p.triangle == q.triangle &&
           std::fabs(p.overlap - q.overlap) <= 0.0 && dot(off, off) <= 0.0;
  });
}

/// Unit normals, known slots and triangles, beads in order, nothing beyond reach.
inline void touches_are_sound(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.4 * sample.radius;
  std::int64_t last = 0;
  for (const Touch& touch : wall.touches(sample.beads, 2.0 * reach, reach)) {
    if (!(std::fabs(length(touch.normal) - 1.0) <= 1e-9))
      return out.push_back({"unit normal", text_of("a normal has the length %.12g (overlap %g m)", length(touch.normal), touch.overlap)});
    if (touch.bead < last || touch.bead >= static_cast<std::int64_t>(sample.beads.size()))
      return out.push_back({"order", text_of("bead %g comes after bead %g", static_cast<double>(touch.bead), static_cast<double>(last))});
    last = touch.bead;
    if (touch.material >= slot_count(wall))
      return out.push_back({"material slots", text_of("a contact has the slot %g of %g", touch.material, slot_count(wall))});
    if (touch.triangle != kNoTriangle && touch.triangle >= wall.surface().triangle_count)
      return out.push_back({"surface", text_of("a contact names triangle %g (overlap %g m)", touch.triangle, touch.overlap)});
    if (!(touch.overlap > -reach))
      return out.push_back({"nothing beyond reach", text_of("a gap of %g m is reported at a reach of %g m", -touch.overlap, reach)});
  }
}

/// The deepest contact of a bead is where its distance from the triangles says, and the normal points away from the wall.
inline void touches_are_where_the_wall_is(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.4 * sample.radius;
  for (const ProbeBead& bead : sample.beads) {
    const double expected = bead.radius - distance_to_surface(wall, bead.position).distance;
    const std::vector<Touch> touches = wall.touches({bead}, reach, reach);
    const Touch* touch = deepest(touches);
    if (touch == nullptr) {
      if (expected > -reach + sample.tolerance)
        return out.push_back({"contact where the distance says",
                              text_of("nothing is reported, the triangles give an overlap of %g m (reach %g m)", expected, reach)});
      continue;
    }
    if (!(std::fabs(touch->overlap - expected) <= sample.tolerance))
      return out.push_back(
          {"contact where the distance says", text_of("the overlap is %g m, the triangles give %g m", touch->overlap, expected)});
  }
}

/// δ = r − distance: a bead that is larger by a length overlaps more by that length; one that moves by a step along d overlaps less by n·d
/// times the step, up to the wall's curvature. Places where the nearest part of the wall changes have a kink and are left out.
inline void overlap_follows_the_bead(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.4 * sample.radius, step = 1e-4 * sample.radius;
  std::size_t asked = 0;
  const auto overlap_at = [&](const ProbeBead& bead) {
    const std::vector<Touch> touches = wall.touches({bead}, reach, reach);
    const Touch* touch = deepest(touches);
    return touch == nullptr ? -HUGE_VAL : touch->overlap;
  };
  for (const ProbeBead& bead : sample.beads) {
    const std::vector<Touch> touches = wall.touches({bead}, reach, reach);
    const Touch* touch = deepest(touches);
    if (touch == nullptr || touch->overlap < -0.3 * sample.radius) continue;
    const double larger = overlap_at({bead.position, bead.radius + step}) - touch->overlap;
    if (!(std::fabs(larger - step) <= 1e-6 * step + 1e-15))
      return out.push_back({"overlap = radius - distance", text_of("a radius larger by %g m overlaps more by %g m", step, larger)});
    const Point directions[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Point& d : directions) {
      const double ahead = overlap_at({bead.position + step * d, bead.radius}),
                   behind = overlap_at({bead.position - step * d, bead.radius});
      if (std::fabs(ahead + behind - 2.0 * touch->overlap) > 1e-3 * step) continue;  // a kink
      ++asked;
      const double slope = (ahead - behind) / (2.0 * step), expected = -dot(touch->normal, d);
      if (!(std::fabs(slope - expected) <= 1e-3))
        return out.push_back({"normal", text_of("moving a bead changes the overlap by %g m per m, its normal says %g", slope, expected)});
    }
  }
  if (asked < 30)
    out.push_back({"normal", text_of("only %g of %g places could be asked; give a bead_radius that suits the wall",
                                     static_cast<double>(asked), static_cast<double>(3 * sample.beads.size()))});
}

/// What is in reach was a candidate, however narrow the margin.
inline void candidates_are_complete(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.2 * sample.radius;
  for (std::size_t i = 0; i < sample.beads.size(); ++i) {
    const std::vector<Touch> narrow = wall.touches({sample.beads[i]}, reach, reach),
                             broad = wall.touches({sample.beads[i]}, 5.0 * reach, reach);
    const Touch *found = deepest(narrow), *expected = deepest(broad);
    if (expected == nullptr || (found != nullptr && found->overlap >= expected->overlap - 1e-12)) continue;
    return out.push_back({"candidates", text_of("a contact of overlap %g m is missed with the margin %g m", expected->overlap, reach)});
  }
}

/// The same question gives the same answer, bead by bead as for all; too little room keeps the first.
inline void answers_are_the_same(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.4 * sample.radius;
  const std::vector<Touch> all = wall.touches(sample.beads, reach, reach);
  if (!same_touches(all, wall.touches(sample.beads, reach, reach)))
    return out.push_back({"determinism", "a second call gives other contacts"});
  std::vector<Touch> one_by_one;
  for (std::size_t i = 0; i < sample.beads.size(); ++i) {
    for (Touch touch : wall.touches({sample.beads[i]}, reach, reach)) {
      touch.bead = static_cast<std::int64_t>(i);
      one_by_one.push_back(touch);
    }
  }
  if (!same_touches(all, one_by_one)) return out.push_back({"bead by bead", "a bead alone has other contacts than among others"});
  std::vector<Touch> bare = all;
  for (Touch& touch : bare) touch.triangle = kNoTriangle;
  wall.asks_for_triangles = false;
  if (!same_touches(bare, wall.touches(sample.beads, reach, reach)))
    out.push_back({"triangles", "where nobody asks for triangles there are other contacts"});
  wall.asks_for_triangles = true;
  const std::size_t room = all.size() / 2;
  if (!same_touches({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(room)}, wall.touches(sample.beads, reach, reach, room)))
    out.push_back({"capacity", "with half the room the contacts are not the first half"});
}

/// While a bead slides along the wall and its normal does not jump, its feature stays: histories of contacts hang from it.
inline void features_stay(WallProbe& wall, const WallSample& sample, Violations& out) {
  const double reach = 0.4 * sample.radius, step = 0.05 * sample.radius;
  for (const ProbeBead& start : sample.beads) {
    ProbeBead bead = start;
    std::vector<Touch> before = wall.touches({bead}, reach, reach);
    if (before.size() != 1) continue;
    const Point& n = before[0].normal;
    const Point along = cross(n, std::fabs(n.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0});
    for (int k = 0; k < 40; ++k) {
      bead.position = bead.position + (step / length(along)) * along;
      const std::vector<Touch> now = wall.touches({bead}, reach, reach);
      if (now.size() != 1 || length(now[0].normal - before[0].normal) > 1e-9 + 0.2 * step / sample.radius ||
          now[0].material != before[0].material)
        break;
      if (now[0].feature != before[0].feature)
        return out.push_back(
            {"feature", text_of("sliding along the smooth wall the feature changes from %g to %g", before[0].feature, now[0].feature)});
      before = now;
    }
  }
}

}  // namespace detail

/// Every check of a geometry with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_geometry(const Descriptor& descriptor, const Values& values, const GeometrySetting& setting = {}) {
  Violations out;
  WallProbe wall(table_of<GeometryTable>(descriptor, Kind::geometry, kGeometryLayout), values);
  if (!detail::surface_is_sound(wall, out)) return out;
  const detail::WallSample sample = detail::sample_wall(wall, setting);
  if (sample.beads.size() < setting.bead_count / 4)
    out.push_back({"surface", "few beads fit before its triangles: they must be counter-clockwise seen from the beads' side"});
  detail::touches_are_sound(wall, sample, out);
  detail::touches_are_where_the_wall_is(wall, sample, out);
  detail::overlap_follows_the_bead(wall, sample, out);
  detail::candidates_are_complete(wall, sample, out);
  detail::answers_are_the_same(wall, sample, out);
  detail::features_stay(wall, sample, out);
  return out;
}

}  // namespace millscope::conformance
