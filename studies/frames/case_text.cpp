#include "studies/frames/case_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/config/imported.hpp"
#include "kernel/config/units.hpp"
#include "kernel/config/writer.hpp"

namespace millscope::frames {
namespace {

using config::number_text;

constexpr std::size_t kMostSizes = 30;

struct Size {
  double diameter = 0;
  std::size_t beads = 0;
};

/// The diameters that there are; where they are many, as many groups of equal number, each with the bead of its mean volume.
std::vector<Size> sizes_of(std::vector<double> radii) {
  std::sort(radii.begin(), radii.end());
  std::vector<Size> sizes;
  for (const double r : radii) {
    if (sizes.empty() || 2 * r > sizes.back().diameter * (1 + 1e-6)) sizes.push_back({2 * r, 0});
    ++sizes.back().beads;
  }
  if (sizes.size() <= kMostSizes) return sizes;
  sizes.clear();
  for (std::size_t g = 0; g < kMostSizes; ++g) {
    const std::size_t first = g * radii.size() / kMostSizes, last = (g + 1) * radii.size() / kMostSizes;
    double cubes = 0;
    for (std::size_t i = first; i < last; ++i) cubes += std::pow(radii[i], 3) / static_cast<double>(last - first);
    sizes.push_back({2 * std::cbrt(cubes), last - first});
  }
  return sizes;
}

/// Beads of one type, whose density is one; others of the type, with other densities, are counted with their mean.
struct Class {
  std::vector<double> radii;
  double mass = 0, volume = 0;
};

std::map<long long, Class> classes_of(const Census& census) {
  std::map<long long, Class> classes;
  for (const BeadKind& bead : census.beads()) {
    Class& c = classes[bead.type];
    c.radii.push_back(bead.radius);
    c.mass += bead.mass(), c.volume += bead.mass() / bead.density;
  }
  return classes;
}

std::string beads_text(const Census& census) {
  std::string materials = "materials:\n", beads = "beads:\n";
  const auto all = static_cast<double>(census.beads().size());
  for (const auto& [type, c] : classes_of(census)) {
    const std::string name = material_name(type);
    materials += fmt::format("  {}: {{density: {}}}\n", name, number_text(c.mass / c.volume));
    beads += fmt::format("  {}:\n    material: {}\n    share: {}\n    fractions_by: number\n    sizes:\n", name, name,
                         number_text(static_cast<double>(c.radii.size()) / all));
    for (const Size& size : sizes_of(c.radii))
      beads += fmt::format("      - {{diameter: {}, fraction: {}}}\n", number_text(size.diameter),
                           number_text(static_cast<double>(size.beads) / static_cast<double>(c.radii.size())));
  }
  return materials + beads;
}

/// The turn that takes the axes of the files to ours, as an axis and an angle (Rodrigues).
std::string placement_text(const Placement& p) {
  const auto& r = p.rows;
  const double trace = r[0][0] + r[1][1] + r[2][2], angle = std::acos(std::clamp(0.5 * (trace - 1), -1.0, 1.0));
  base::Vector3 axis{r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]};
  if (std::fabs(base::dot(axis, axis)) < 1e-12 && angle > 1) {
    // Half a turn: R = 2 a aᵀ − 1, and the longest column of R + 1 is along a.
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) longest = r[k][k] > r[longest][longest] ? k : longest;
    for (std::size_t k = 0; k < 3; ++k) axis[k] = r[k][longest] + (k == longest ? 1 : 0);
  }
  const base::Vector3 shift = p.place({0, 0, 0});
  std::string text;
  if (angle > 1e-12)
    text += fmt::format("    rotate_axis: [{}, {}, {}]\n    rotate_angle: {}\n", number_text(axis[0]), number_text(axis[1]),
                        number_text(axis[2]), number_text(angle));
  return text + fmt::format("    translate: [{}, {}, {}]\n", number_text(shift[0]), number_text(shift[1]), number_text(shift[2]));
}

std::string geometry_text(const CaseOfImport& c) {
  const MillFile& mill = c.mill;
  std::string text = "geometry:\n  shell:\n";
  if (mill.liner.empty()) {
    text += fmt::format("    kind: cylinder\n    radius: {}\n    length: {}\n    end_faces: {}\n", number_text(0.5 * mill.diameter),
                        number_text(mill.length), mill.periodic ? "false" : "true");
  } else {
    text += fmt::format("    kind: mesh\n    file: {}\n    unit: {}\n{}", config::quoted(mill.liner), mill.liner_unit,
                        placement_text(mill.placement));
    if (mill.periodic) text += fmt::format("    period: {}\n", number_text(mill.length));
  }
  return text + fmt::format("    motion: {{rotation: {{speed: mill, start_s: {}}}}}\n", number_text(c.turning.start));
}

}  // namespace

std::string case_text(const CaseOfImport& c) {
  const MillFile& mill = c.mill;
  std::string text =
      "# Another program moved these beads; 'millscope import' wrote down what is known of their mill. There is no physics to run.\n";
  text += fmt::format("schema_version: 1\nname: {}\nrun: {{engine: {}}}\n", config::quoted(mill.name), config::kImported);
  text += beads_text(c.census);
  text += fmt::format("fill: {{count: {}, shares_by: number", std::llround(c.count));
  if (mill.porosity) text += fmt::format(", porosity: {}", number_text(*mill.porosity));
  text += "}\n";
  text += fmt::format("body_forces: {{gravity: {{kind: gravity, magnitude: {}}}}}\n", number_text(mill.gravity));
  text += fmt::format("mill: {{speed: {}, diameter: {}, direction: {}}}\n", number_text(std::fabs(c.turning.omega)),
                      number_text(mill.diameter), c.turning.omega < 0 ? "clockwise" : "counter_clockwise");
  text += geometry_text(c);
  if (mill.periodic) text += fmt::format("domain: {{periodic: {{z: [0, {}]}}}}\n", number_text(mill.length));
  return text + fmt::format("time: {{end_s: {}, analyze_from_s: {}}}\n", number_text(c.end), number_text(c.analyze_from));
}

}  // namespace millscope::frames
