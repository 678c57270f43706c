#include "kernel/output/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "kernel/base/vector3.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace {

struct Corners {
  base::Vector3 a, b, c, normal;
};

Corners corners_of(const Surface& surface, std::uint64_t triangle) {
  const auto vertex = [&](std::uint64_t k) {
    const double* at = surface.vertices + std::size_t{3} * surface.triangles[3 * triangle + k];
    return base::Vector3{at[0], at[1], at[2]};
  };
  Corners t{vertex(0), vertex(1), vertex(2), {0, 0, 0}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    t.normal[k] = (t.b[p] - t.a[p]) * (t.c[q] - t.a[q]) - (t.b[q] - t.a[q]) * (t.c[p] - t.a[p]);
  }
  const double length = std::hypot(t.normal[0], t.normal[1], t.normal[2]);
  for (double& component : t.normal) component = length > 0 ? component / length : 0;
  return t;
}

std::string solid_name(const std::string& slot) {
  std::string name = slot.empty() ? "all" : slot;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isspace(c) != 0 || std::iscntrl(c) != 0; }, '_');
  return name;
}

std::uint32_t slot_of(const Surface& surface, std::uint64_t triangle) {
  return surface.triangle_materials == nullptr ? 0 : surface.triangle_materials[triangle];
}

void write_solid(AtomicFile& file, const Surface& surface, std::uint32_t slot, const std::string& name) {
  bool open = false;
  for (std::uint64_t k = 0; k < surface.triangle_count; ++k) {
    if (slot_of(surface, k) != slot) continue;
    if (!open) file.write(fmt::format("solid {}\n", name));
    open = true;
    const Corners t = corners_of(surface, k);
    file.write(fmt::format("facet normal {}\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n", fmt::join(t.normal, " "),
                           fmt::join(t.a, " "), fmt::join(t.b, " "), fmt::join(t.c, " ")));
  }
  if (open) file.write(fmt::format("endsolid {}\n", name));
}

// 80 bytes of title, a count, then 50 bytes per triangle: normal, three corners (float), attribute word.
void write_binary(AtomicFile& file, const Surface& surface) {
  std::string title = "millscope surface, metres; attribute word: material slot";
  title.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(surface.triangle_count);
  file.write(title);
  file.write({reinterpret_cast<const char*>(&count), 4});
  for (std::uint64_t k = 0; k < surface.triangle_count; ++k) {
    const Corners t = corners_of(surface, k);
    for (const base::Vector3* point : {&t.normal, &t.a, &t.b, &t.c}) {
      const std::array<float, 3> rounded{static_cast<float>((*point)[0]), static_cast<float>((*point)[1]), static_cast<float>((*point)[2])};
      file.write({reinterpret_cast<const char*>(rounded.data()), sizeof rounded});
    }
    const auto slot = static_cast<std::uint16_t>(slot_of(surface, k));
    file.write({reinterpret_cast<const char*>(&slot), 2});
  }
}

}  // namespace

void write_stl(const std::filesystem::path& path, const Surface& surface, std::span<const std::string> slots, StlFormat format) {
  for (std::uint64_t k = 0; k < surface.triangle_count; ++k) {
    if (slot_of(surface, k) >= slots.size()) throw std::logic_error("write_stl: a triangle's material slot has no name");
  }
  AtomicFile file(path);
  if (format == StlFormat::binary) {
    write_binary(file, surface);
  } else {
    for (std::uint32_t slot = 0; slot < slots.size(); ++slot) write_solid(file, surface, slot, solid_name(slots[slot]));
  }
  file.commit();
}

}  // namespace millscope::output
