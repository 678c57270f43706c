#include "kernel/run/wear.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/output/archive.hpp"

namespace millscope::run {

void write_wear(const Assembly& a, const std::filesystem::path& path) {
  output::ArchiveWriter archive(path);
  archive.write_value("counted_s", static_cast<double>(std::max<std::int64_t>(a.system->step() - a.analyze_step, 0)) * a.time_step);
  for (std::size_t b = 0; b < a.geometries.size(); ++b) {
    const Surface& s = a.geometries[b].surface;
    if (s.triangle_count == 0) continue;
    const std::string at = "walls/" + a.system->bodies[b].name + "/";
    archive.write(at + "vertices_m", std::span<const double>(s.vertices, 3 * s.vertex_count));
    archive.write(at + "triangles", std::span<const std::uint32_t>(s.triangles, 3 * s.triangle_count));
    archive.write(at + "material", std::span<const std::uint32_t>(s.triangle_materials, s.triangle_count));
    archive.write(at + "worn_m3", a.system->worn_volume(b));
  }
  archive.commit();
}

WornSurface read_wear(const std::filesystem::path& path, const std::string& body) {
  const output::ArchiveReader archive(path);
  const std::string at = "walls/" + body + "/";
  if (!archive.has(at + "worn_m3")) {
    throw base::UserError(fmt::format("{}: has no wear of '{}', which has no surface there; name another geometry", path.string(), body));
  }
  return {archive.read<double>(at + "vertices_m"), archive.read<std::uint32_t>(at + "triangles"),
          archive.read<std::uint32_t>(at + "material"), archive.read<double>(at + "worn_m3"), archive.read_value<double>("counted_s")};
}

}  // namespace millscope::run
