#include "studies/new/liner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "kernel/config/document.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/objects.hpp"

namespace millscope::new_mill {
namespace {

using base::UserError;

host::GeometryObject make_mesh(const std::string& file, const std::string& unit, bool turned, const host::Registry& registry) {
  const host::Loaded& plugin = registry.find(Kind::geometry, "mesh");
  nlohmann::json values = {{"file", file}, {"unit", unit}};  // JSON's quoting is also YAML's
  if (turned) values.update({{"axis", "auto"}, {"centre", true}});
  const config::Node node = config::parse_document(values.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "--liner");
  return host::GeometryObject::create(plugin, config::resolve(*plugin.descriptor, node, Scope::instance).view(), {"--liner", 0});
}

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
      "'repeat' in a case of your own: docs/importing_a_liner.md); 'millscope geometry report {} --unit {}' shows what is there",
      file, box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2], file, unit));
}

}  // namespace

std::vector<std::string> mesh_units(const host::Registry& registry) {
  std::vector<std::string> units;
  const Descriptor& mesh = *registry.find(Kind::geometry, "mesh").descriptor;
  for (std::uint64_t i = 0; i < mesh.parameter_count; ++i) {
    if (std::string_view(mesh.parameters[i].name) != "unit") continue;
    std::stringstream choices(mesh.parameters[i].choices);
    for (std::string choice; std::getline(choices, choice, '|');) units.push_back(choice);
  }
  return units;
}

Liner look_at_liner(const std::string& file, const std::string& unit, const host::Registry& registry) {
  Liner liner;
  liner.file = file;
  liner.unit = unit;
  host::GeometryObject mesh = make_mesh(file, unit, false, registry);
  Interior in{};
  mesh.table().interior(mesh.self(), &in);
  if (in.is_cylinder == 0) {
    const Interior box = in;
    try {
      mesh = make_mesh(file, unit, true, registry);
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
