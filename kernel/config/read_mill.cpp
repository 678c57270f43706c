// `mill`, `geometry` and its motion.
#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "kernel/config/imported.hpp"
#include "kernel/config/reader.hpp"

namespace millscope::config {
namespace {

constexpr Dimension kCritical{0, 0, 0, 0, 0, 1};

/// Magnitude of an angular speed that may be in %critical.
double read_angular_speed(const Node& node, const std::optional<double>& critical) {
  const Quantity quantity = read_quantity(node);
  if (!quantity.has_unit || quantity.unit.dimension != kCritical) return read_number(node, "rad/s");
  if (!critical) node.fail(fmt::format("is '{}', but the critical speed needs 'mill.diameter'; add it", node.text()));
  return quantity.unit.to_si(quantity.number) * *critical;
}

/// `speed`: of the body, rad/s.
std::optional<RippleCase> read_ripple(const std::optional<Node>& node, double speed) {
  if (!node) return std::nullopt;
  node->expect({"amplitude", "frequency", "per_turn", "phase"});
  RippleCase ripple;
  ripple.amplitude = read_number(node->at("amplitude", "part of the speed, e.g. 2 %"), "1", between(0, 1));
  if (const auto per_turn = node->find("per_turn")) {
    if (node->has("frequency")) per_turn->fail("is given beside 'frequency'; give one of them");
    ripple.per_turn = read_number(*per_turn, "1", positive());
    ripple.frequency = *ripple.per_turn * std::fabs(speed) / (2 * std::numbers::pi);
  } else {
    ripple.frequency = read_number(node->at("frequency", "e.g. 10 Hz, or per_turn: 1"), "1/s", positive());
  }
  ripple.phase = number_or(*node, "phase", "rad", any_number(), 0);
  return ripple;
}

Vector3 vector_or(const Node& section, std::string_view key, std::string_view si_unit, const Vector3& fallback) {
  const auto node = section.find(key);
  return node ? read_vector(*node, si_unit) : fallback;
}

Vector3 read_axis(const Node& section) {
  const auto node = section.find("axis");
  if (!node) return {0, 0, 1};
  Vector3 axis = read_vector(*node, "1");
  const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  if (!(length > 0)) node->fail("has no length; give a direction such as [0, 0, 1]");
  if (std::fabs(length - 1) > 1e-12) {
    for (double& component : axis) component /= length;
  }
  return axis;
}

RotationCase read_rotation(const Node& node, const std::optional<MillCase>& mill) {
  node.expect({"speed", "axis", "point", "start_s", "ramp_s", "ripple"});
  RotationCase rotation;
  const auto speed = node.find("speed");
  rotation.follows_mill = !speed || (speed->is_scalar() && speed->text() == "mill");
  if (rotation.follows_mill && !mill) node.fail("follows the mill's speed, but there is no section 'mill'; add it or give 'speed'");
  rotation.speed = rotation.follows_mill ? mill->speed : read_angular_speed(*speed, mill ? mill->critical_speed : std::nullopt);
  rotation.axis = read_axis(node);
  rotation.point = vector_or(node, "point", "m", {0, 0, 0});
  rotation.start = number_or(node, "start_s", "s", not_negative(), 0);
  rotation.ramp = number_or(node, "ramp_s", "s", not_negative(), 0);
  rotation.ripple = read_ripple(node.find("ripple"), rotation.speed);
  return rotation;
}

TranslationCase read_translation(const Node& node) {
  node.expect({"velocity", "oscillation", "start_s"});
  TranslationCase translation;
  translation.velocity = vector_or(node, "velocity", "m/s", {0, 0, 0});
  translation.start = number_or(node, "start_s", "s", not_negative(), 0);
  const auto oscillation = node.find("oscillation");
  if (!oscillation) return translation;
  oscillation->expect({"amplitude", "frequency", "phase"});
  translation.amplitude = read_vector(oscillation->at("amplitude", "[x, y, z] in m"), "m");
  translation.frequency = read_number(oscillation->at("frequency", "e.g. 10 Hz"), "1/s", positive());
  translation.phase = number_or(*oscillation, "phase", "rad", any_number(), 0);
  return translation;
}

GeometryCase read_one_geometry(const Node& node, const std::string& name, const Case& c) {
  GeometryCase g;
  g.plugin = {name, node.at("kind", "the name of a geometry plugin, e.g. mesh or mill").text(), node, node.where()};
  if (const auto material = node.find("material")) g.material = read_material_name(*material, c.materials);
  if (const auto slots = node.find("materials")) {
    for (const std::string& slot : slots->keys()) g.materials.emplace_back(slot, read_material_name(slots->at(slot), c.materials));
  }
  if (g.material.empty() && g.materials.empty() && !is_imported(c))
    node.at("material", "the name of a material, or 'materials: {slot: name}'");
  if (const auto motion = node.find("motion")) g.motion = read_motion(*motion, c.mill);
  return g;
}

}  // namespace

const std::string& GeometryCase::material_of(std::string_view slot) const {
  for (const auto& [name, slot_material] : materials) {
    if (name == slot) return slot_material;
  }
  if (material.empty())
    plugin.node.fail(fmt::format("says no material for its part '{}'; add 'material' or 'materials: {{{}: name}}'", slot, slot));
  return material;
}

double critical_speed(double mill_diameter, double bead_diameter) {
  return 42.3 / std::sqrt(mill_diameter - bead_diameter) * std::numbers::pi / 30;
}

MillCase read_mill(const Node& section, double largest_diameter) {
  section.expect({"speed", "diameter", "direction"});
  MillCase mill;
  if (const auto diameter = section.find("diameter")) {
    const Range range{largest_diameter, kUnbounded, true, false, "it must be larger than the largest bead"};
    mill.diameter = read_number(*diameter, "m", range);
    mill.critical_speed = critical_speed(*mill.diameter, largest_diameter);
  }
  if (const auto direction = section.find("direction")) {
    const bool clockwise = read_choice(*direction, "counter_clockwise|clockwise") == "clockwise";
    mill.direction = clockwise ? Direction::clockwise : Direction::counter_clockwise;
  }
  const Node speed = section.at("speed", "e.g. 75 %critical or 58.4 rpm");
  mill.speed = read_angular_speed(speed, mill.critical_speed);
  check_range(speed, mill.speed, "rad/s", not_negative("the sense of turning is said by 'direction'"));
  if (mill.direction == Direction::clockwise) mill.speed = -mill.speed;
  return mill;
}

MotionCase read_motion(const Node& node, const std::optional<MillCase>& mill) {
  MotionCase motion;
  if (node.is_scalar()) {
    if (read_choice(node, "fixed|mill") == "fixed") return motion;
    if (!mill) node.fail("follows the mill's speed, but there is no section 'mill'; add it");
    motion.rotation = RotationCase{};
    motion.rotation->speed = mill->speed;
    return motion;
  }
  node.expect({"rotation", "translation"});
  if (const auto rotation = node.find("rotation")) motion.rotation = read_rotation(*rotation, mill);
  if (const auto translation = node.find("translation")) motion.translation = read_translation(*translation);
  return motion;
}

std::vector<GeometryCase> read_geometry(const Node& section, const Case& c) {
  std::vector<GeometryCase> geometry;
  bool turns = false;
  for (const std::string& name : section.keys()) {
    const Node node = section.at(name);
    check_name(name, node.where(), "geometry");
    geometry.push_back(read_one_geometry(node, name, c));
    turns = turns || (geometry.back().motion.rotation && geometry.back().motion.rotation->follows_mill);
  }
  if (c.mill && !turns && !geometry.empty())
    section.fail("has no body that turns with the mill, though 'mill.speed' is given; add 'motion: mill' to the liner");
  return geometry;
}

}  // namespace millscope::config
