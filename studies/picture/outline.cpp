#include "studies/picture/outline.hpp"

#include <array>
#include <cmath>
#include <numeric>

#include "kernel/base/error.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/objects.hpp"
#include "studies/picture/results_pictures.hpp"

namespace millscope::picture {
namespace {

struct Vertex {
  double x, y, z;
};

Vertex vertex_of(const Surface& surface, std::uint64_t triangle, int corner) {
  const double* v = surface.vertices + 3 * static_cast<std::uint64_t>(surface.triangles[3 * triangle + static_cast<std::uint64_t>(corner)]);
  return {v[0], v[1], v[2]};
}

/// The cut of one triangle: two ends, or none.
bool cut(const std::array<Vertex, 3>& t, double z, std::array<double, 4>& segment) {
  std::size_t ends = 0;
  for (std::size_t i = 0; i < 3 && ends < 2; ++i) {
    const Vertex &a = t[i], &b = t[(i + 1) % 3];
    if ((a.z < z) == (b.z < z)) continue;
    const double part = (z - a.z) / (b.z - a.z);
    segment[2 * ends] = std::lerp(a.x, b.x, part), segment[2 * ends + 1] = std::lerp(a.y, b.y, part);
    ++ends;
  }
  return ends == 2;
}

}  // namespace

std::vector<std::array<double, 4>> section_of(const Surface& surface, double z, double radius) {
  std::vector<std::array<double, 4>> lines;
  for (std::uint64_t t = 0; t < surface.triangle_count; ++t) {
    std::array<double, 4> line{};
    if (!cut({vertex_of(surface, t, 0), vertex_of(surface, t, 1), vertex_of(surface, t, 2)}, z, line)) continue;
    const double inner = std::min(std::hypot(line[0], line[1]), std::hypot(line[2], line[3]));
    if (inner < 0.998 * radius) lines.push_back(line);
  }
  return lines;
}

MillOutline outline_of(const analysis::ResultSet& results, const host::Registry& registry, std::string& why) {
  MillOutline outline = shell_of(results);
  const AnalyzerContext& context = results.meta.context;
  why.clear();
  if (results.meta.case_file.empty() || !(context.mill_radius > 0)) return outline;
  try {
    const config::Case c = config::read_case(results.meta.case_file);
    for (const config::GeometryCase& g : c.geometry) {
      const host::Loaded& plugin = registry.find(Kind::geometry, g.plugin.kind, g.plugin.where);
      const config::ResolvedValues values = config::resolve(*plugin.descriptor, g.plugin.node, Scope::instance);
      const auto object = host::GeometryObject::create(plugin, values.view(), g.plugin.where);
      Surface surface{};
      object.table().surface(object.self(), &surface);
      // A little off the middle, where a mesh is likely to have its vertices.
      const double z = std::lerp(context.mill_low, context.mill_high, 0.4987);
      for (const auto& line : section_of(surface, z, context.mill_radius)) outline.section.push_back(line);
    }
  } catch (const base::UserError& e) {
    outline.section.clear();
    why = e.what();
  }
  return outline;
}

}  // namespace millscope::picture
