#include "studies/frames/mill_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/error.hpp"
#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"

namespace millscope::frames {
namespace {

using base::Vector3;
using config::Node;
using config::positive;
using config::read_number;

std::optional<double> number(const Node& section, std::string_view key, std::string_view unit, const config::Range& range = positive()) {
  const auto node = section.find(key);
  return node ? std::optional(read_number(*node, unit, range)) : std::nullopt;
}

config::Range up_to(double highest, const char* reason) {
  config::Range range = positive(reason);
  range.high = highest;
  return range;
}

/// "-z": a direction in the files.
Vector3 direction(const Node& node) {
  std::string_view text = node.text();
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') node.fail(fmt::format("is '{}'; write one of x, y, z, -x, -y, -z", node.text()));
  Vector3 v{};
  v[static_cast<std::size_t>(text[0] - 'x')] = negative ? -1 : 1;
  return v;
}

/// Our axes: z along the mill, y up, x as the right hand has it.
void read_axes(const Node& root, MillFile& mill) {
  const Node axis = root.at("axis", "the axis of the files that the mill turns about, e.g. y; the end that it points to is nearest to you");
  const Node gravity = root.at("gravity", "where things fall in the files, e.g. -z, or {direction: -z, magnitude: 9.81 m/s^2}");
  Node down = gravity;
  if (gravity.is_map()) {
    gravity.expect({"direction", "magnitude"});
    down = gravity.at("direction", "where things fall in the files, e.g. -z");
    mill.gravity = number(gravity, "magnitude", "m/s^2").value_or(mill.gravity);
  }
  auto& rows = mill.placement.rows;
  rows[2] = direction(axis);
  rows[1] = direction(down);
  for (double& component : rows[1]) component = component == 0 ? 0 : -component;
  if (base::dot(rows[1], rows[2]) != 0)
    down.fail(fmt::format("is '{}', along the mill's axis '{}'; mills lie here: correct one of them", down.text(), axis.text()));
  rows[0] = base::cross(rows[1], rows[2]);
}

void read_ends(const Node& node, MillFile& mill) {
  const auto items = node.items();
  if (items.size() != 2) node.fail("wants where the mill begins and ends along its axis, e.g. [-100 mm, 100 mm]");
  mill.placement.low = read_number(items[0], "m");
  mill.length = read_number(items[1], "m") - mill.placement.low;
  if (!(mill.length > 0)) node.fail("must rise along 'axis'; where the axis is -y, an end at y = 100 mm stands at -100 mm along it");
  if (mill.length > 40) node.fail(fmt::format("is {:.4g} m long, and no mill is; say the unit, e.g. [0 mm, 200 mm]", mill.length));
}

void read_speed(const Node& section, MillFile& mill) {
  if (const auto direction = section.find("direction"))
    mill.sense = config::read_choice(*direction, "counter_clockwise|clockwise") == "clockwise" ? -1 : 1;
  mill.start = number(section, "start_s", "s", config::not_negative()).value_or(0);
  const auto node = section.find("speed");
  if (!node) return;
  const config::Quantity quantity = config::read_quantity(*node);
  const config::Range range = config::not_negative("the sense of turning is said by 'direction'");
  if (quantity.has_unit && quantity.unit.dimension == config::parse_unit("%critical").dimension) {
    mill.of_critical = quantity.unit.to_si(quantity.number);
    config::check_range(*node, *mill.of_critical, "1", range);
  } else {
    mill.speed = read_number(*node, "rad/s", range);
  }
}

void read_mill(const Node& section, MillFile& mill) {
  section.expect({"diameter", "ends", "periodic", "centre", "speed", "direction", "start_s", "liner"});
  mill.diameter =
      read_number(section.at("diameter", "of the bare shell, e.g. 300 mm"), "m", up_to(20, "no mill is larger; say the unit, e.g. 300 mm"));
  if (const auto centre = section.find("centre")) mill.placement.centre = config::read_vector(*centre, "m");
  read_ends(section.at(
                "ends",
                "where the mill begins and ends along its axis, in the files, e.g. [-100 mm, 100 mm]; of a slice that repeats, its period"),
            mill);
  if (const auto periodic = section.find("periodic")) mill.periodic = config::read_flag(*periodic);
  read_speed(section, mill);
  if (const auto liner = section.find("liner")) {
    liner->expect({"file", "unit"});
    mill.liner = config::existing_file(liner->at("file", "an STL, OBJ, PLY, … in the axes of the files"));
    mill.liner_unit = config::read_choice(liner->at("unit", "in which the mesh was drawn: mm, m, cm, inch"), "mm|m|cm|inch");
  }
}

/// One number, or `{1: …, steel: …}` by type.
ByType read_by_type(const Node& section, std::string_view key, std::string_view unit, const config::Range& range) {
  ByType values;
  values.node = section.find(key);
  if (!values.node) return values;
  if (!values.node->is_map()) {
    values.all = read_number(*values.node, unit, range);
    return values;
  }
  for (const std::string& name : values.node->keys()) {
    values.of[name] = read_number(values.node->at(name), unit, range);
  }
  return values;
}

void read_beads(const Node& section, MillFile& mill) {
  section.expect({"density", "diameter", "porosity"});
  mill.density =
      read_by_type(section, "density", "kg/m^3", config::between(25, 25000, "it is in kg/m^3, or say the unit, e.g. 2.5 g/cm^3"));
  mill.diameter_of_beads = read_by_type(section, "diameter", "m", up_to(1, "no bead is larger; say the unit, e.g. 5 mm"));
  config::Range part = config::between(0, 1, "it is the part of the charge's volume that is no bead");
  part.open_high = true;
  mill.porosity = number(section, "porosity", "1", part);
}

void read_files(const Node& node, MillFile& mill) {
  std::vector<Node> all{node};
  if (node.is_sequence()) all = node.items();
  for (const Node& one : all) {
    for (const std::string& file : config::matching_files(one)) {
      if (std::find(mill.files.begin(), mill.files.end(), std::filesystem::path(file)) != mill.files.end())
        one.fail(fmt::format("names '{}' a second time; each frame counts once", std::filesystem::path(file).filename().string()));
      mill.files.emplace_back(file);
    }
  }
  if (mill.files.empty()) node.fail("is an empty list; name at least one file of frames");
}

/// Of the files, in that of `si`.
double read_unit(const Node& node, const char* si) {
  try {
    const config::Unit unit = config::parse_unit(node.text());
    if (unit.dimension == config::parse_unit(si).dimension) return unit.to_si(1);
  } catch (const std::exception&) {
  }
  node.fail(fmt::format("is '{}', which is no unit like {}; write e.g. {}", node.text(), si,
                        std::string_view(si) == "rad/s" ? "rad/s, deg/s or rpm" : fmt::format("{} or m{}", si, si)));
}

}  // namespace

Vector3 Placement::place(const Vector3& v) const {
  Vector3 ours = turned({v[0] - centre[0], v[1] - centre[1], v[2] - centre[2]});
  ours[2] = base::dot(rows[2], v) - low;
  return ours;
}

std::optional<double> ByType::value(long long type, const std::string& word) const {
  if (of.empty()) return all;
  const std::string key = word.empty() ? std::to_string(type) : word;
  const auto found = of.find(key);
  if (found == of.end()) node->fail(fmt::format("says nothing of type {}, which the files hold; add it", key));
  return found->second;
}

MillFile read_mill_file(const std::filesystem::path& file) {
  MillFile mill;
  mill.file = file.string();
  if (file.extension() != ".yaml" && file.extension() != ".yml")
    throw base::UserError(
        fmt::format("{}: is no .yaml; write one that names this file and says its mill: 'files: {}', axis, gravity, mill (docs/import.md)",
                    mill.file, file.filename().string()));
  const Node root = mill.root = config::load_document(mill.file);
  root.expect({"schema_version", "name", "files", "length_unit", "velocity_unit", "spin_unit", "axis", "gravity", "mill", "beads", "time"});
  if (const auto version = root.find("schema_version")) {
    if (config::read_integer(*version, config::between(1, 1e9)) != 1) version->fail("is not 1; this millscope reads version 1");
  }
  const auto name = root.find("name");
  mill.name = name ? name->text() : file.stem().string();
  read_files(root.at("files", "the files of frames, e.g. post/dump_*.txt, or a list"), mill);
  if (const auto unit = root.find("length_unit")) mill.length_unit = mill.velocity_unit = read_unit(*unit, "m");
  if (const auto unit = root.find("velocity_unit")) mill.velocity_unit = read_unit(*unit, "m/s");
  if (const auto unit = root.find("spin_unit")) mill.spin_unit = read_unit(*unit, "rad/s");
  read_axes(root, mill);
  read_mill(root.at("mill", "the mill of the frames: {diameter: 300 mm, ends: [0 mm, 200 mm], speed: 40 rpm}"), mill);
  if (const auto beads = root.find("beads")) read_beads(*beads, mill);
  if (const auto time = root.find("time")) {
    time->expect({"step", "interval", "analyze_from"});
    mill.time_step = number(*time, "step", "s");
    mill.interval = number(*time, "interval", "s");
    mill.analyze_from = number(*time, "analyze_from", "s", config::not_negative());
    if (mill.time_step && mill.interval) time->fail("gives both 'step', of the program, and 'interval', between frames; keep one");
  }
  root.finish();
  return mill;
}

}  // namespace millscope::frames
