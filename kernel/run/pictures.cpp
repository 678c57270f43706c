#include "kernel/run/pictures.hpp"

#include <fmt/format.h>

namespace millscope::run {
namespace {

namespace fs = std::filesystem;

output::PictureSeries open(const fs::path& folder, const char* name, std::optional<double> resume_time) {
  fs::create_directories(folder);
  return resume_time ? output::PictureSeries::resume(folder / name, *resume_time) : output::PictureSeries::create(folder / name);
}

/// Where the vertices of a surface are at a time, s: [V,3] m.
std::vector<double> vertices_at(const Surface& s, const dem::Motion& motion, double time) {
  const dem::Pose pose = dem::pose_at(motion, time);
  std::vector<double> moved(3 * s.vertex_count);
  for (std::uint64_t v = 0; v < s.vertex_count; ++v) {
    for (std::size_t r = 0; r < 3; ++r) {
      moved[3 * v + r] = pose.offset[r];
      for (std::size_t c = 0; c < 3; ++c) moved[3 * v + r] += pose.rotation[r][c] * s.vertices[3 * v + c];
    }
  }
  return moved;
}

}  // namespace

Pictures::Pictures(const fs::path& folder, std::optional<double> resume_time)
    : folder_(folder), beads_(open(folder, "beads.pvd", resume_time)), walls_(open(folder, "mesh.pvd", resume_time)) {}

void Pictures::add(const Assembly& a, double time, std::int64_t number, const output::BeadPicture& beads, const dem::System* worked) {
  const std::string name = fmt::format("beads_{:06d}.vtp", number);
  output::write_beads_vtp(folder_ / name, beads);
  beads_.add(time, name);
  for (std::size_t b = 0; b < a.geometries.size(); ++b) {
    const Surface& s = a.geometries[b].surface;
    if (s.triangle_count == 0) continue;
    const std::vector<double> moved = vertices_at(s, a.system->bodies[b].motion, time);
    std::vector<double> impact, shear, worn;
    if (worked != nullptr) impact = worked->impact_work(b), shear = worked->shear_work(b);
    if (worked != nullptr && !a.c.contact.wear.empty()) worn = worked->worn_volume(b);
    const std::string wall = fmt::format("{}_{:06d}.vtp", a.system->bodies[b].name, number);
    output::write_mesh_vtp(folder_ / wall,
                           {moved, {s.triangles, 3 * s.triangle_count}, {s.triangle_materials, s.triangle_count}, impact, shear, worn});
    walls_.add(time, wall, static_cast<int>(b));
  }
}

}  // namespace millscope::run
