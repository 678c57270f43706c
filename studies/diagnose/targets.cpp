// Values of the case that may be other than they are said to be.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "kernel/config/units.hpp"
#include "studies/diagnose/candidates.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kWorn = 0.6;  // of the height that is left of a lifter at the far end of its wear
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAngle = 15 * kDegree;  // by which a lifter's face may be off
constexpr double kRipple = 0.1;          // of the speed
constexpr double kSteepest = 89 * kDegree;

double number(const config::Node& node) {
  const config::Quantity q = config::read_quantity(node);
  return q.has_unit ? q.unit.to_si(q.number) : q.number;
}

void lifters(const config::GeometryCase& g, std::vector<Candidate>& out) {
  const config::Node& node = g.plugin.node;
  if (!node.has("lifters") || !node.has("lifter_height") || number(node.at("lifters")) < 1) return;
  const std::string at = "geometry." + g.plugin.name + ".";
  const double height = number(node.at("lifter_height"));
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
  const double angle = node.has("lifter_face_angle") ? number(node.at("lifter_face_angle")) : 60 * kDegree;
  const double steep = std::min(angle + kAngle, kSteepest), shallow = angle - kAngle;
  const double far = steep < angle + kAngle ? shallow : steep;
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

/// Faces that turn with the shell are exchanged for planes at rest.
void resting_ends(const config::GeometryCase& g, std::vector<Candidate>& out) {
  const config::Node& node = g.plugin.node;
  if (!node.has("end_faces") || node.at("end_faces").text() != "true" || !g.motion.rotation || !node.has("length")) return;
  const std::string& material = g.material.empty() ? g.materials.front().second : g.material;
  const double length = number(node.at("length"));
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
  c.set = {fmt::format("{}={{rotation: {{speed: mill, ripple: {{amplitude: 0, frequency: {:.6g}}}}}}}", at,
                       std::abs(base.mill->speed) / (2 * std::numbers::pi))};
  c.paths = {at + ".rotation.ripple.amplitude"};
  out.push_back(std::move(c));
}

}  // namespace

std::vector<Candidate> targets_of(const config::Case& base) {
  std::vector<Candidate> out;
  for (const config::GeometryCase& g : base.geometry) {
    if (g.plugin.kind != "mill") continue;
    lifters(g, out);
    resting_ends(g, out);
    ripple(base, g, out);
  }
  return out;
}

}  // namespace millscope::diagnose
