// Values of the case that may be other than they are said to be.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include "kernel/config/units.hpp"
#include "studies/diagnose/question/candidates.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kWorn = 0.6;  // of the height that is left of a lifter at the far end of its wear
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAngle = 15 * kDegree;  // by which a lifter's face may be off
constexpr double kRipple = 0.1;          // of the speed
constexpr double kSlippery = 0.2;        // friction of the lifters over that of the shell
constexpr double kRough = 2;
constexpr double kSteepest = 89 * kDegree;
constexpr double kNarrowTop = 0.1;  // of a lifter's base: no face so shallow that the top would be narrower

constexpr double kTracers = 0.05;   // of the beads: enough to be followed, too few to change how the charge moves
constexpr double kHeavyTracer = 2;  // times the density of the charge
constexpr double kLightTracer = 0.5;
constexpr double kSpread = 0.15;  // standard deviation of the diameters over their mean
constexpr double kEqual = 0.005;  // spread of beads that pass for equal
constexpr double kStiffer = 4;    // times the stiffness: half the time step

double si_value(const config::Node& node) {
  const config::Quantity q = config::read_quantity(node);
  return q.has_unit ? q.unit.to_si(q.number) : q.number;
}

void lifters(const config::GeometryCase& g, std::vector<Candidate>& out) {
  const config::Node& node = g.plugin.node;
  if (!node.has("lifters") || !node.has("lifter_height") || si_value(node.at("lifters")) < 1) return;
  const std::string at = "geometry." + g.plugin.name + ".";
  const double height = si_value(node.at("lifter_height"));
  out.push_back({"lifter_wear",
                 "The lifters are worn: lower than the drawing says.",
                 "h < h_0",
                 "",
                 "lifter_height",
                 "m",
                 {},
                 {at + "lifter_height"},
                 height,
                 kWorn * height,
                 {},
                 {}});
  const double angle = node.has("lifter_face_angle") ? si_value(node.at("lifter_face_angle")) : 60 * kDegree;
  // The top is w - 2 h / tan(angle) wide.
  const double width = node.has("lifter_width") ? si_value(node.at("lifter_width")) : 0;
  const double narrowest = std::atan2(2 * height, (1 - kNarrowTop) * width);
  const double steep = std::min(angle + kAngle, kSteepest), shallow = std::min(angle, std::max(angle - kAngle, narrowest));
  const double far = steep - angle < angle - shallow - 1e-9 ? shallow : steep;
  if (far == angle) return;  // neither steeper nor shallower can be
  out.push_back({"lifter_face_angle",
                 "The faces of the lifters stand at another angle than the drawing says.",
                 "",
                 "",
                 "lifter_face_angle",
                 "rad",
                 {},
                 {at + "lifter_face_angle"},
                 angle,
                 far,
                 {std::min(0.0, ((far == steep ? shallow : steep) - angle) / (far - angle)), 1},
                 {}});
}

std::string free_name(const config::Case& base, std::string name) {
  const auto taken = [&](const config::MaterialCase& m) { return m.name == name; };
  const bool grouped = base.root.has("groups") && base.root.at("groups").has(name);
  if (!grouped && std::none_of(base.materials.begin(), base.materials.end(), taken)) return name;
  return free_name(base, name + "_");
}

/// Lifters of a material of their own, that is the shell's but for its friction, which follows the shell's.
void lifter_friction(const config::Case& base, const config::GeometryCase& g, std::vector<Candidate>& out) {
  const config::Node& node = g.plugin.node;
  if (!node.has("lifters") || si_value(node.at("lifters")) < 1 || g.material_of("shell") != g.material_of("lifter")) return;
  const config::MaterialCase& shell = base.material(g.material_of("shell"));
  const std::string name = free_name(base, "lifters");
  Candidate c{"lifter_friction",
              "The lifters rub otherwise than the shell between them.",
              "mu_lifter = r mu_shell",
              "",
              "friction_ratio",
              "1",
              {fmt::format("materials.{}={{density: {:.17g}, young_modulus: {:.17g}, poisson_ratio: {:.17g}}}", name, shell.density,
                           shell.young, shell.poisson),
               fmt::format(fmt::runtime(g.materials.empty() ? "geometry.{}.materials={{lifter: {}}}" : "geometry.{}.materials.lifter={}"),
                           g.plugin.name, name)},
              {},
              1,
              kSlippery,
              {(kRough - 1) / (kSlippery - 1), 1},
              {}};
  std::set<std::string> of_beads;
  for (const config::BeadCase& beads : base.beads) of_beads.insert(beads.material);
  for (const std::string& bead : of_beads) {
    const config::Node like = base.pairs.lookup(bead, shell.name);
    if (!like.has("static_friction")) return;
    const std::string pair = config::normal_pair(fmt::format("{}~{}", bead, name));
    c.set.push_back(fmt::format("pairs.{}={{like: {}, times: {{static_friction: 1}}}}", pair, like.name()));
    c.paths.push_back(fmt::format("pairs.{}.times.static_friction", pair));
  }
  out.push_back(std::move(c));
}

/// Faces that turn with the shell are exchanged for planes at rest.
void resting_ends(const config::GeometryCase& g, std::vector<Candidate>& out) {
  const config::Node& node = g.plugin.node;
  if (!node.has("end_faces") || node.at("end_faces").text() != "true" || !g.motion.rotation || !node.has("length")) return;
  const std::string& material = g.material.empty() ? g.materials.front().second : g.material;
  const double length = si_value(node.at("length"));
  Candidate c{"end_faces_at_rest",
              "The end faces stand still while the shell turns.",
              "Omega_end = 0",
              "Alizadeh et al. 2013",
              "on",
              "",
              {},
              {},
              0,
              1,
              {},
              {}};
  c.set = {"geometry." + g.plugin.name + ".end_faces=false",
           fmt::format("geometry.end_low={{kind: plane, point: [0, 0, 0], normal: [0, 0, 1], material: {}}}", material),
           fmt::format("geometry.end_high={{kind: plane, point: [0, 0, {:.6g}], normal: [0, 0, -1], material: {}}}", length, material)};
  out.push_back(std::move(c));
}

/// The shell turns unevenly, once per turn.
void ripple(const config::Case& base, const config::GeometryCase& g, std::vector<Candidate>& out) {
  if (!base.mill || base.mill->speed == 0 || !g.motion.rotation || !g.motion.rotation->follows_mill || g.motion.rotation->ripple ||
      g.motion.translation)
    return;
  const std::string at = "geometry." + g.plugin.name + ".motion";
  Candidate c{"speed_ripple",
              "The shell turns unevenly, once in a turn.",
              "Omega (1 + a sin(Omega t))",
              "",
              "amplitude",
              "1",
              {},
              {},
              0,
              kRipple,
              {},
              {}};
  c.set = {at + "={rotation: {speed: mill, ripple: {amplitude: 0, per_turn: 1}}}"};
  c.paths = {at + ".rotation.ripple.amplitude"};
  out.push_back(std::move(c));
}

/// The one class of equal beads of a case without tracers, or null.
const config::BeadCase* equal_beads(const config::Case& base) {
  const bool one = base.beads.size() == 1 && !base.has_tracers() && base.beads[0].sizes.size() == 1;
  return one && base.root.at("beads").at(base.beads[0].name).has("diameter") ? &base.beads[0] : nullptr;
}

/// Sets apart the part of a class that is followed, at first like the rest.
std::vector<std::string> tracers_of(const config::BeadCase& beads) {
  return {"fill.shares_by=number", fmt::format("beads.{}.share={}", beads.name, 1 - kTracers),
          fmt::format("beads.tracer={{material: {}, diameter: {:.6g}, density: {:.6g}, share: {}, tracer: true}}", beads.material,
                      beads.sizes[0].diameter, beads.density, kTracers)};
}

void unlike_tracer(const config::BeadCase& beads, std::vector<Candidate>& out) {
  const double rho = beads.density;
  out.push_back({"unlike_tracer",
                 "The recorded bead is not of the density of the charge.",
                 "rho_tracer != rho",
                 "",
                 "density",
                 "kg/m^3",
                 tracers_of(beads),
                 {"beads.tracer.density"},
                 rho,
                 kHeavyTracer * rho,
                 {(kLightTracer - 1) / (kHeavyTracer - 1), 1},
                 {"size_spread"}});
}

/// The tracer stays of the nominal size.
void size_spread(const config::BeadCase& beads, std::vector<Candidate>& out) {
  const double d = beads.sizes[0].diameter;
  Candidate c{"size_spread",
              "The beads of the charge are not of one size.",
              "d ~ normal(d_0, s)",
              "",
              "deviation",
              "m",
              tracers_of(beads),
              {fmt::format("beads.{}.distribution.deviation", beads.name)},
              kEqual * d,
              kSpread * d,
              {},
              {"unlike_tracer"}};
  c.set.push_back(fmt::format("beads.{}.diameter=~", beads.name));
  c.set.push_back(fmt::format("beads.{}.fractions_by=number", beads.name));
  c.set.push_back(fmt::format("beads.{0}.distribution={{kind: normal, mean: {1:.6g}, deviation: {2:.6g}}}", beads.name, d, kSpread * d));
  out.push_back(std::move(c));
}

/// Softening lengthens contacts and lets beds pack more densely.
void stiffness(const config::Case& base, std::vector<Candidate>& out) {
  const double factor = base.stiffness_factor;
  if (factor >= 1) return;
  out.push_back({"contact_stiffness",
                 "The contacts are stiffer than the simulation takes them to be.",
                 "E = s E_material",
                 "",
                 "stiffness_factor",
                 "1",
                 {},
                 {"stiffness_factor"},
                 factor,
                 std::min(1.0, kStiffer * factor),
                 {},
                 {}});
}

/// What each target needs of a case.
constexpr std::array<std::array<const char*, 2>, 8> kNeeds{{
    {"contact_stiffness", "softened contacts: a stiffness_factor below 1"},
    {"end_faces_at_rest", "a geometry of kind mill whose end_faces turn"},
    {"lifter_face_angle", "a geometry of kind mill with lifters whose faces could be steeper or shallower"},
    {"lifter_friction",
     "a geometry of kind mill with lifters of the shell's material, and a static_friction of the pairs of bead and shell"},
    {"lifter_wear", "a geometry of kind mill with lifters"},
    {"size_spread", "one class of beads, given by its 'diameter', without tracers of its own"},
    {"speed_ripple", "a geometry of kind mill that follows the mill's speed, without a ripple or travel of its own"},
    {"unlike_tracer", "one class of beads, given by its 'diameter', without tracers of its own"},
}};

std::vector<Candidate> applying(const config::Case& base) {
  std::vector<Candidate> out;
  if (const config::BeadCase* beads = equal_beads(base)) {
    unlike_tracer(*beads, out);
    size_spread(*beads, out);
  }
  stiffness(base, out);
  for (const config::GeometryCase& g : base.geometry) {
    if (g.plugin.kind != "mill") continue;
    lifters(g, out);
    lifter_friction(base, g, out);
    resting_ends(g, out);
    ripple(base, g, out);
  }
  return out;
}

}  // namespace

void add_targets(const config::Case& base, Library& library) {
  std::vector<Candidate> targets = applying(base);
  for (const auto& [name, need] : kNeeds) {
    if (std::none_of(targets.begin(), targets.end(), [n = name](const Candidate& c) { return c.name == n; }))
      library.left_out.push_back(fmt::format("{}: needs {}", name, need));
  }
  std::move(targets.begin(), targets.end(), std::back_inserter(library.candidates));
}

}  // namespace millscope::diagnose
