#include "studies/new/liner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kernel/host/geometry_file.hpp"

namespace millscope::new_mill {
namespace {

using base::UserError;

/// Whether triangles across z cover most of the circle at that height.
bool has_wall(const Surface& s, double z, double radius, double length) {
  double area = 0;
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    const double* v[3];
    bool here = true;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = s.vertices + std::size_t{3} * s.triangles[3 * t + k];
      here = here && std::fabs(v[k][2] - z) < 1e-3 * length;
    }
    if (here) area += 0.5 * std::fabs((v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]));
  }
  return area > 0.5 * std::numbers::pi * radius * radius;
}

[[noreturn]] void refuse_shape(const std::string& file, const std::string& unit, const Interior& box) {
  throw UserError(fmt::format(
      "--liner {}: no ring round an axis (its box is {:.4g} x {:.4g} x {:.4g} m); give the whole liner, not one segment of it (that takes "
      "'repeat' in a case of your own: docs/importing_a_liner.md); 'millscope geometry report {}{}' shows what is there",
      file, box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2], file, unit.empty() ? "" : " --unit " + unit));
}

}  // namespace

Liner look_at_liner(const std::string& file, const std::string& unit, const host::Registry& registry) {
  Liner liner;
  liner.file = file;
  liner.unit = unit;
  liner.kind = host::reader_of(file, registry).name();
  host::GeometryObject mesh = host::open_geometry({file, unit, "--liner-unit", false}, registry);
  Interior in{};
  mesh.table().interior(mesh.self(), &in);
  if (in.is_cylinder == 0) {
    const Interior box = in;
    try {
      mesh = host::open_geometry({file, unit, "--liner-unit", true}, registry);
      mesh.table().interior(mesh.self(), &in);
    } catch (const UserError&) {  // it could be read a moment ago: no axis is found
    }
    if (in.is_cylinder == 0) refuse_shape(file, unit, box);
    liner.turned = true;
  }
  liner.radius = in.radius;
  liner.low = in.low[2];
  liner.high = in.high[2];
  if (liner.radius < 0.01 || liner.radius > 10) {
    throw UserError(
        fmt::format("--liner {}: with --liner-unit {} its shell is {:.4g} m wide, which no mill is; give the unit in which it was drawn",
                    file, unit, 2 * liner.radius));
  }
  Surface surface{};
  mesh.table().surface(mesh.self(), &surface);
  liner.wall_low = has_wall(surface, liner.low, liner.radius, liner.high - liner.low);
  liner.wall_high = has_wall(surface, liner.high, liner.radius, liner.high - liner.low);
  return liner;
}

}  // namespace millscope::new_mill
