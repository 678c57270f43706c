// `condition` of recording.yaml: what the user says of the mill.
#include <fmt/format.h>

#include <cmath>

#include "kernel/config/case.hpp"
#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"
#include "studies/recording/description.hpp"

namespace millscope::recording {
namespace {

using config::Node;
using config::positive;
using config::read_number;

std::optional<double> number(const Node& section, std::string_view key, std::string_view unit, const config::Range& range) {
  const auto node = section.find(key);
  return node ? std::optional(read_number(*node, unit, range)) : std::nullopt;
}

constexpr double kLongestSlice = 10;  // m

config::Range positive_up_to(double highest, const char* reason) {
  config::Range range = positive(reason);
  range.high = highest;
  return range;
}

/// Of beads: from foam to tungsten and beyond; what was meant in g/cm³, 22.6 at most, lies below.
config::Range bead_densities() { return config::between(25, 25000, "it is in kg/m^3, or say the unit, e.g. 2.5 g/cm^3"); }

/// The diameter of the bare shell that a case file gives in its section `mill`.
std::optional<double> diameter_of_case(const std::string& file) {
  const Node root = config::load_document(file);
  const auto mill = root.find("mill");
  return mill ? number(*mill, "diameter", "m", positive()) : std::nullopt;
}

void read_geometry(const Node& section, Condition& condition) {
  const auto node = section.find("geometry");
  if (!node) return;
  condition.geometry = config::existing_file(*node);
  const auto diameter = diameter_of_case(condition.geometry.string());
  if (!diameter) return;
  if (condition.mill_diameter && std::fabs(*diameter - *condition.mill_diameter) > 1e-9 * *diameter) {
    node->fail(fmt::format("has a mill of {} m in '{}', but 'mill_diameter' says {} m; correct one of them", *diameter, node->text(),
                           *condition.mill_diameter));
  }
  condition.mill_diameter = diameter;
}

/// `speed: 75 %critical`, `36 rpm`; with `direction`, or with a sign, Ω is known, else only its magnitude.
void read_speed(const Node& section, Condition& condition) {
  const auto direction = section.find("direction");
  const auto node = section.find("speed");
  if (!node) {
    if (direction) direction->fail("is of no use without 'speed'; add it, e.g. speed: 36 rpm");
    return;
  }
  const config::Quantity quantity = config::read_quantity(*node);
  double speed = 0;
  if (quantity.has_unit && quantity.unit.dimension == config::parse_unit("%critical").dimension) {
    if (!condition.mill_diameter || !condition.bead_diameter) {
      node->fail(fmt::format("is '{}', which needs mill_diameter and bead_diameter; add them or give rpm", node->text()));
    }
    speed = quantity.unit.to_si(quantity.number) * config::critical_speed(*condition.mill_diameter, *condition.bead_diameter);
  } else {
    speed = read_number(*node, "rad/s");
  }
  condition.speed = std::fabs(speed);
  if (speed == 0) node->fail("is 0; a mill at rest needs no 'speed'");
  if (direction && speed < 0) node->fail("has a sign beside 'direction'; leave one of them out");
  const bool clockwise = direction && config::read_choice(*direction, "counter_clockwise|clockwise") == "clockwise";
  if (direction || speed < 0) condition.angular_velocity = (clockwise || speed < 0 ? -1 : 1) * *condition.speed;
}

Slice read_slice(const Node& node) {
  const auto items = node.items();
  if (items.size() != 2) node.fail("wants where the slice begins and ends along z, e.g. [0 mm, 20 mm]");
  const Slice slice{read_number(items[0], "m"), read_number(items[1], "m")};
  if (!(slice.high > slice.low)) node.fail("must rise; the first is its end at the smaller z");
  if (slice.length() > kLongestSlice)
    node.fail(fmt::format("is {:.4g} m long, and no slice is; say the unit, e.g. [0 mm, 20 mm]", slice.length()));
  return slice;
}

}  // namespace

Condition read_condition(const Node& section) {
  section.expect({"speed", "direction", "filling", "porosity", "bead_diameter", "bead_density", "tracer", "mill_diameter", "mill_length",
                  "slice", "power", "geometry"});
  Condition condition;
  condition.filling = number(section, "filling", "1", config::between(0, 1, "it is a part of the bare shell's volume"));
  config::Range part = config::between(0, 1, "it is the part of the charge's volume that is no bead");
  part.open_high = true;
  condition.porosity = number(section, "porosity", "1", part);
  condition.bead_diameter = number(section, "bead_diameter", "m", positive());
  condition.bead_density = number(section, "bead_density", "kg/m^3", bead_densities());
  if (const auto tracer = section.find("tracer")) {
    tracer->expect({"diameter", "density"});
    condition.tracer.diameter = number(*tracer, "diameter", "m", positive());
    condition.tracer.density = number(*tracer, "density", "kg/m^3", bead_densities());
  }
  condition.mill_diameter = number(section, "mill_diameter", "m", positive_up_to(20, "no mill is larger; say the unit, e.g. 300 mm"));
  condition.mill_length = number(section, "mill_length", "m", positive_up_to(40, "no mill is longer; say the unit, e.g. 60 mm"));
  if (const auto slice = section.find("slice")) condition.slice = read_slice(*slice);
  if (const auto power = section.find("power")) {
    power->expect({"value", "sem"});
    condition.power = MeasuredPower{read_number(power->at("value", "the power given to the charge, e.g. 7.34 W"), "W"),
                                    read_number(power->at("sem", "its standard error, e.g. 0.01 W"), "W", config::not_negative())};
  }
  read_geometry(section, condition);
  if (condition.mill_diameter && condition.bead_diameter && *condition.bead_diameter >= *condition.mill_diameter) {
    section.at("bead_diameter")
        .fail(fmt::format("is {} m, not smaller than the mill of {} m", *condition.bead_diameter, *condition.mill_diameter));
  }
  read_speed(section, condition);
  return condition;
}

}  // namespace millscope::recording
