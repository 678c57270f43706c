#include "kernel/run/bodies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>

#include "kernel/base/nearest.hpp"
#include "kernel/config/values.hpp"

namespace millscope::run {
namespace {

using base::UserError;

/// A geometry with the values that it was made of.
struct Made {
  GeometryUse use;
  config::ResolvedValues values;
};

Made make_geometry(const config::GeometryCase& g, const host::Registry& registry) {
  const host::Loaded& plugin = registry.find(Kind::geometry, g.plugin.kind, g.plugin.where);
  Made made;
  made.values = config::resolve(*plugin.descriptor, g.plugin.node, Scope::instance);
  GeometryUse& use = made.use;
  use.object = host::GeometryObject::create(plugin, made.values.view(), g.plugin.where);
  std::stringstream slots(use.object.table().material_slots(use.object.self()));
  for (std::string slot; std::getline(slots, slot, '|');) use.slots.push_back(slot);
  use.object.table().surface(use.object.self(), &use.surface);
  use.object.table().interior(use.object.self(), &use.interior);
  return made;
}

/// A misspelt part would silently take the `material` of the rest.
void check_slots(const config::GeometryCase& g, const std::vector<std::string>& slots) {
  for (const auto& [name, material] : g.materials) {
    if (std::find(slots.begin(), slots.end(), name) != slots.end()) continue;
    g.plugin.node.at("materials").at(name).fail(fmt::format("is no part of this geometry; {}", base::suggestion(name, slots)));
  }
}

struct Corners {
  const double* vertex[3];
};

Corners corners_of(const Surface& s, std::uint64_t triangle) {
  Corners c{};
  for (std::size_t k = 0; k < 3; ++k) c.vertex[k] = s.vertices + std::size_t{3} * s.triangles[3 * triangle + k];
  return c;
}

/// Cosine of the angle between a triangle's normal and a unit vector, 0 … 1.
double alignment(const Corners& c, const double* direction) {
  double n[3], along = 0, square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    n[k] = (c.vertex[1][p] - c.vertex[0][p]) * (c.vertex[2][q] - c.vertex[0][q]) -
           (c.vertex[1][q] - c.vertex[0][q]) * (c.vertex[2][p] - c.vertex[0][p]);
    along += n[k] * direction[k];
    square += n[k] * n[k];
  }
  return square > 0 ? std::fabs(along) / std::sqrt(square) : 0;
}

/// The lists of walls need a bound of the wall's speed. An endless body has one only where it turns in itself.
void check_motion(const config::GeometryCase& g, const GeometryUse& use) {
  if (use.interior.is_bounded || !g.motion.rotation || g.motion.rotation->speed == 0) return;
  bool in_itself = use.surface.triangle_count > 0;
  for (std::uint64_t t = 0; t < use.surface.triangle_count; ++t)
    in_itself = in_itself && alignment(corners_of(use.surface, t), g.motion.rotation->axis.data()) > 1 - 1e-12;
  if (in_itself) return;
  throw UserError(g.plugin.where, fmt::format("'{}' is endless and can turn about its own normal only, because its speed has no bound "
                                              "otherwise; use a box or a mesh, or give the rotation the normal as axis",
                                              g.plugin.node.path()));
}

struct Range {
  double low = 1e300, high = -1e300;
};

Range range_along_z(const Surface& s) {
  Range r;
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    for (const double* x : corners_of(s, t).vertex) r.low = std::min(r.low, x[2]), r.high = std::max(r.high, x[2]);
  }
  return r;
}

/// `period` of a geometry: the same as the domain's, and the surface where the domain is. Copies stand half a period beyond each end.
void check_period(const config::GeometryCase& g, const Made& made, double period, const config::Case& c) {
  const base::Location& where = made.values.where("period");
  const std::string name = g.plugin.node.path();
  const double low = c.domain.box.low[2], high = c.domain.box.high[2], length = high - low;
  if (!c.domain.periodic[2]) {
    throw UserError(where, fmt::format("'{}.period' is {} m, but the domain is not periodic along z; add domain.periodic.z or leave "
                                       "period out",
                                       name, period));
  }
  if (std::fabs(period - length) > 1e-6 * length) {
    throw UserError(
        where, fmt::format("'{}.period' is {} m, but domain.periodic.z is {:.6g} m long; both must be the same", name, period, length));
  }
  const Range own = range_along_z(made.use.surface);
  if (std::fabs(own.low - low) <= std::max(0.5 * period - 0.5 * c.largest_diameter(), 1e-3 * period)) return;
  throw UserError(where, fmt::format("'{}' covers z from {:.6g} to {:.6g} m, but domain.periodic.z is [{:.6g}, {:.6g}] m; move the one or "
                                     "the other, e.g. by translate: [0, 0, {:.6g}]",
                                     name, own.low, own.high, low, high, low - own.low));
}

/// A surface that may have a period and has none, in a periodic domain: a bead across the border does not feel its end. That changes
/// nothing where the end reaches the border and is parallel to z.
void check_ends(const config::GeometryCase& g, const Made& made, const config::Case& c) {
  const Surface& s = made.use.surface;
  const Range own = range_along_z(s);
  const double low = c.domain.box.low[2], high = c.domain.box.high[2], near = 0.5 * c.largest_diameter();
  constexpr double kAlongZ[3] = {0, 0, 1};
  for (const bool upper : {false, true}) {
    const double gap = upper ? high - own.high : own.low - low;
    if (std::fabs(gap) > near) continue;
    bool ends_well = gap <= 1e-3 * (high - low);
    for (std::uint64_t t = 0; t < s.triangle_count && ends_well; ++t) {
      const Corners corners = corners_of(s, t);
      const bool reaches_end = std::any_of(std::begin(corners.vertex), std::end(corners.vertex),
                                           [&](const double* x) { return upper ? x[2] > own.high - near : x[2] < own.low + near; });
      ends_well = !reaches_end || alignment(corners, kAlongZ) < 1e-3;
    }
    if (ends_well) continue;
    throw UserError(g.plugin.where,
                    fmt::format("'{}' ends at z = {:.6g} m, at the border of domain.periodic.z, and beads beyond the border would not feel "
                                "it; give it period: {:.6g} m (and no end walls), or keep it a bead's radius away from the border",
                                g.plugin.node.path(), upper ? own.high : own.low, high - low));
  }
}

/// The first cylinder is the vessel: it holds the charge over the whole period.
void check_vessel(const config::GeometryCase& g, const Interior& in, const config::DomainCase& domain) {
  const double low = domain.box.low[2], high = domain.box.high[2], tolerance = 1e-3 * (high - low);
  if (std::fabs(in.axis[2]) < 0.999 || (in.low[2] <= low + tolerance && in.high[2] >= high - tolerance)) return;
  throw UserError(g.plugin.where, fmt::format("'{}' covers z from {:.6g} to {:.6g} m, but domain.periodic.z is [{:.6g}, {:.6g}] m; make "
                                              "both the same",
                                              g.plugin.node.path(), in.low[2], in.high[2], low, high));
}

/// The periodic domain along z against the geometries. A parameter `period` is known by its name, whichever plugin has it.
void check_periodic(const config::Case& c, const std::vector<Made>& all) {
  bool is_vessel = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const config::GeometryCase& g = c.geometry[i];
    const Values values = all[i].values.view();
    const Value* const end = values.items + values.count;
    const Value* const period = std::find_if(values.items, end, [](const Value& v) { return std::string_view(v.name) == "period"; });
    const Interior& in = all[i].use.interior;
    const bool is_cylinder = in.is_bounded && in.is_cylinder;
    if (period != end && period->number[0] > 0) {
      check_period(g, all[i], period->number[0], c);
    } else if (c.domain.periodic[2]) {
      if (is_vessel && is_cylinder) check_vessel(g, in, c.domain);
      if (period != end) check_ends(g, all[i], c);
    }
    is_vessel = is_vessel && !is_cylinder;
  }
}

}  // namespace

std::vector<GeometryUse> make_geometries(const config::Case& c, const host::Registry& registry) {
  std::vector<Made> all;
  for (const config::GeometryCase& g : c.geometry) {
    all.push_back(make_geometry(g, registry));
    check_slots(g, all.back().use.slots);
    check_motion(g, all.back().use);
  }
  check_periodic(c, all);
  std::vector<GeometryUse> geometries;
  for (Made& made : all) geometries.push_back(std::move(made.use));
  return geometries;
}

dem::Motion motion_of(const config::MotionCase& m, double ahead) {
  dem::Motion r;
  r.ahead = ahead;
  if (m.rotation) {
    r.speed = m.rotation->speed;
    r.axis = m.rotation->axis;
    r.point = m.rotation->point;
    r.start = m.rotation->start;
    r.ramp = m.rotation->ramp;
    if (m.rotation->ripple) {
      r.ripple_amplitude = m.rotation->ripple->amplitude;
      r.ripple_frequency = m.rotation->ripple->frequency;
      r.ripple_phase = m.rotation->ripple->phase;
    }
  }
  if (m.translation) {
    r.velocity = m.translation->velocity;
    r.oscillation_amplitude = m.translation->amplitude;
    r.oscillation_frequency = m.translation->frequency;
    r.oscillation_phase = m.translation->phase;
    r.translation_start = m.translation->start;
  }
  return r;
}

double greatest_distance(const Surface& s, const dem::Motion& m) {
  double greatest = 0;
  for (std::uint64_t v = 0; v < s.vertex_count; ++v) {
    double d[3], along = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      d[a] = s.vertices[3 * v + a] - m.point[a];
      along += d[a] * m.axis[a];
    }
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) square += (d[a] - along * m.axis[a]) * (d[a] - along * m.axis[a]);
    greatest = std::max(greatest, std::sqrt(square));
  }
  return greatest;
}

config::Box swept(const Surface& s, const dem::Motion& m, double end) {
  config::Box box;
  box.low.fill(1e300);
  box.high.fill(-1e300);
  for (std::uint64_t v = 0; v < s.vertex_count; ++v) {
    const double* x = s.vertices + 3 * v;
    double along = 0, square = 0;
    for (std::size_t a = 0; a < 3; ++a) along += (x[a] - m.point[a]) * m.axis[a];
    for (std::size_t a = 0; a < 3; ++a) {
      const double off = x[a] - m.point[a] - along * m.axis[a];
      square += off * off;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      // A vertex that turns runs on a circle round the axis.
      const double centre = m.speed != 0 ? m.point[a] + along * m.axis[a] : x[a];
      const double reach = m.speed != 0 ? std::sqrt(square * std::max(0.0, 1 - m.axis[a] * m.axis[a])) : 0.0;
      box.low[a] = std::min(box.low[a], centre - reach);
      box.high[a] = std::max(box.high[a], centre + reach);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const double shift = m.velocity[a] * std::max(0.0, end - m.translation_start), swing = 2 * std::abs(m.oscillation_amplitude[a]);
    box.low[a] += std::min(0.0, shift) - swing;
    box.high[a] += std::max(0.0, shift) + swing;
  }
  return box;
}

}  // namespace millscope::run
