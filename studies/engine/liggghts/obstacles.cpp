#include "studies/engine/liggghts/obstacles.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "kernel/run/recorder.hpp"
#include "studies/engine/liggghts/physics.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

/// Collects one line for each obstacle.
class Obstacles {
 public:
  void add(const config::Location& where, const std::string& what) {
    all_.push_back(where.file.empty() ? what : fmt::format("{}:{}: {}", where.file, where.line, what));
  }
  std::vector<std::string> take() { return std::move(all_); }

 private:
  std::vector<std::string> all_;
};

void check_law(const run::Assembly& a, const host::Registry& registry, Obstacles& found) {
  const config::PluginInstance& law = a.c.contact.law;
  if (law.kind != "hertz_mindlin") {
    found.add(law.where, fmt::format("contact.law '{}': LIGGGHTS has no such law; the nearest is hertz_mindlin", law.kind));
    return;
  }
  if (instance_text(law, Kind::contact_law, "cap", registry) != "spring") {
    found.add(law.where, "contact.law: cap is 'sum', but LIGGGHTS limits the spring alone; set cap: spring");
  }
}

void check_interactions(const run::Assembly& a, const host::Registry& registry, Obstacles& found) {
  int rolling = 0, cohesion = 0;
  for (const config::PluginInstance& use : a.c.contact.interactions) {
    const std::string name = fmt::format("contact.interactions '{}'", use.name);
    const auto needs = [&](const char* parameter, std::string_view wanted) {
      const std::string value = instance_text(use, Kind::interaction, parameter, registry);
      if (value != wanted) found.add(use.where, fmt::format("{}: {} is '{}'; LIGGGHTS knows '{}' alone", name, parameter, value, wanted));
    };
    if (use.kind == "cohesion_sjkr") {
      needs("friction", "contact");
      if (++cohesion == 2) found.add(use.where, fmt::format("{}: LIGGGHTS takes one kind of cohesion; leave one out", name));
    } else if (use.kind == "rolling_epsd" || use.kind == "rolling_constant_torque") {
      needs("length", "effective");
      if (use.kind == "rolling_constant_torque") needs("spin", "relative");
      if (++rolling == 2) found.add(use.where, fmt::format("{}: LIGGGHTS takes one kind of rolling friction; leave one out", name));
    } else {
      found.add(use.where, fmt::format("{}: LIGGGHTS has no '{}'; what it has are rolling_epsd, rolling_constant_torque and cohesion_sjkr",
                                       name, use.kind));
    }
  }
  for (const config::PluginInstance& use : a.c.contact.pair_parameters) {
    found.add(use.where, fmt::format("contact.pair_parameters '{}': in LIGGGHTS restitution and friction are constants; give those of the "
                                     "usual speed under pairs",
                                     use.name));
  }
  for (const config::PluginInstance& use : a.c.contact.wear) {
    found.add(use.where, fmt::format("contact.wear '{}': wear is not counted in LIGGGHTS; leave it out", use.name));
  }
}

void check_forces(const run::Assembly& a, Obstacles& found) {
  for (const config::PluginInstance& use : a.c.body_forces) {
    if (use.kind == "gravity") continue;
    found.add(use.where, fmt::format("body_forces '{}': of these only gravity is handed to LIGGGHTS; leave '{}' out", use.name, use.kind));
  }
}

/// LIGGGHTS loses a triangle whose middle lies outside the box of the beads.
bool reaches_out(const run::Assembly& a, const Surface& surface) {
  for (std::uint64_t t = 0; t < surface.triangle_count; ++t) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Bounds bounds = bounds_of(a, axis);
      double middle = 0;
      for (std::size_t corner = 0; corner < 3; ++corner) middle += surface.vertices[3 * surface.triangles[3 * t + corner] + axis] / 3;
      if (middle < bounds.low || middle > bounds.high) return true;
    }
  }
  return false;
}

void check_geometry(const run::Assembly& a, Obstacles& found) {
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const config::GeometryCase& geometry = a.c.geometry[g];
    const config::Location& where = geometry.plugin.where;
    const std::string name = fmt::format("geometry '{}'", geometry.plugin.name);
    const run::GeometryUse& use = a.geometries[g];
    if (use.surface.triangle_count == 0 || !use.interior.is_bounded)
      found.add(where, fmt::format("{}: '{}' has no end and no surface to export; make it a box or a mesh", name, geometry.plugin.kind));
    else if (reaches_out(a, use.surface))
      found.add(where, fmt::format(
                           "{}: reaches beyond the domain, where LIGGGHTS loses it; make it as long as the domain repeats, or widen domain",
                           name));
    if (geometry.motion.translation)
      found.add(where, fmt::format("{}: its translation is not handed to LIGGGHTS; rotation alone is", name));
  }
}

/// Numbers that LIGGGHTS itself refuses.
void check_numbers(const run::Assembly& a, const host::Registry& registry, Obstacles& found) {
  for (const std::string& name : a.materials) {
    const config::MaterialCase& material = a.c.material(name);
    if (material.poisson < 0)
      found.add(material.where, fmt::format("materials.{}: Poisson's ratio is {}; LIGGGHTS wants 0 to 0.5", name, material.poisson));
  }
  if (a.c.contact.law.kind != "hertz_mindlin") return;
  for (const dem::PairPhysics& pair : a.system->physics()) {
    const double restitution = pair_number(a, registry, a.c.contact.law, pair, "restitution");
    if (restitution <= 0.05)
      found.add(a.c.contact.law.where, fmt::format("pairs.{}: restitution is {}; LIGGGHTS wants more than 0.05", pair.name, restitution));
  }
}

}  // namespace

std::vector<std::string> obstacles_of(const run::Assembly& a, const host::Registry& registry) {
  Obstacles found;
  check_law(a, registry, found);
  check_interactions(a, registry, found);
  check_forces(a, found);
  check_geometry(a, found);
  check_numbers(a, registry, found);
  if (a.c.start) found.add(a.c.start->node.where(), "start: LIGGGHTS cannot take over the contacts of another run; fill the mill anew");
  return found.take();
}

void require_playable(const run::Assembly& a, const host::Registry& registry) {
  run::Recorder::check(a);
  const std::vector<std::string> obstacles = obstacles_of(a, registry);
  if (!obstacles.empty()) throw base::UserError(fmt::format("{}", fmt::join(obstacles, "\n")));
}

std::vector<std::string> differences_of(const run::Assembly& a, const host::Registry& registry) {
  std::vector<std::string> all{
      "LIGGGHTS books no energy by kind: neither dissipation nor a balance",
      "LIGGGHTS damps with the speed of half a step before, here with that of the step",
      "where a bead has sunk into a face, a sharp edge of that face within the bead's radius may push it too in LIGGGHTS (from one side of "
      "the "
      "edge); here the face alone does",
      "at a wall LIGGGHTS takes the wall's speed at its surface, here at half the depth to which the bead sinks in"};
  const config::PluginInstance& law = a.c.contact.law;
  if (instance_number(law, Kind::contact_law, "allow_tension", registry) != 0 &&
      instance_number(law, Kind::contact_law, "friction_in_tension", registry) == 0)
    all.push_back(
        "where damping pulls parting bodies, friction in LIGGGHTS is limited by the size of that force; here there is none "
        "(contact.law.friction_in_tension: true is LIGGGHTS' way)");
  for (const MeshFile& mesh : meshes_of(a)) {
    const double smooth = smooth_degrees(a, mesh);
    if (smooth < kSmoothDegrees)
      all.push_back(fmt::format(
          "faces of '{}' that turn by more than {:.2g}° are one by one in LIGGGHTS: a bead that sinks in there is pushed by several",
          a.c.geometry[mesh.body].plugin.name, smooth));
  }
  bool turns = false, rolling = false;
  for (const config::GeometryCase& geometry : a.c.geometry) {
    turns = turns || geometry.motion.rotation.has_value();
    if (geometry.plugin.kind == "mill" || geometry.plugin.kind == "cylinder")
      all.push_back(
          fmt::format("'{}' is round here and flat triangles there, which stand nearer to the axis in their middle", geometry.plugin.name));
  }
  for (const config::PluginInstance& use : a.c.contact.interactions) {
    if (use.kind == "rolling_constant_torque") {
      rolling = true;
      all.push_back("the constant rolling torque of LIGGGHTS goes with the elastic part of the normal force, here with all of it");
    }
    if (use.kind == "rolling_epsd") {
      rolling = true;
      all.push_back(
          "the rolling spring of LIGGGHTS takes the secant stiffness 4/3 E* a, here the tangent 2 E* a: it is softer there by 1.5");
    }
  }
  if (rolling && turns) {
    all.push_back("at a turning wall LIGGGHTS resists the bead's own spin, here its spin against the wall");
    all.push_back("the torque that LIGGGHTS gives for a wall lacks the rolling moments; the power by centre of mass has them");
  }
  if (a.c.output.series) all.push_back("series.csv has means over about 10 ms, whatever output.series says");
  return all;
}

}  // namespace millscope::engine::liggghts
