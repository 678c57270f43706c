#include "studies/new/questions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/units.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/host/geometry_file.hpp"
#include "studies/new/liner.hpp"
#include "studies/new/materials.hpp"

namespace millscope::new_mill {
namespace {

using base::UserError;
using config::Node;
using config::Range;

constexpr double kShortestSlice = 3.2;  // bead diameters: two reaches of a neighbour list, as the run itself demands
constexpr int kMeshDigits = 5;          // a mesh's coordinates are seldom better

/// A text as a value of a document, and errors with the option in the place of file and line.
template <class Read>
auto read_as_value(const std::string& option, const std::string& text, const Read& read) {
  const Node root = config::parse_document(fmt::format("value: {}", config::quoted(text)), option);
  try {
    return read(root.at("value"));
  } catch (const UserError& e) {
    const std::string place = option + ":1: 'value' ", said = e.what();
    throw UserError(said.starts_with(place) ? fmt::format("--{} {}", option, said.substr(place.size())) : said);
  }
}

/// A number with its unit; a bare one is refused, because what is meant cannot be seen.
Value read_value(const Question& q, const std::string& text, const char* si_unit, const Range& range) {
  const double si = read_as_value(q.option, text, [&](const Node& node) {
    if (!config::read_quantity(node).has_unit)
      node.fail(fmt::format("is '{}', without a unit; write it with one, e.g. --{} \"{}\"", text, q.option, q.standard));
    return config::read_number(node, si_unit, range);
  });
  return {si, text};
}

Value ask_value(const Answer& answer, const Question& q, const char* si_unit, const Range& range) {
  Value value;
  answer(q, [&](const std::string& text) { value = read_value(q, text, si_unit, range); });
  return value;
}

std::string ask_choice(const Answer& answer, const Question& q, const char* choices) {
  std::string chosen;
  answer(q, [&](const std::string& text) {
    chosen = read_as_value(q.option, text, [&](const Node& node) { return config::read_choice(node, choices); });
  });
  return chosen;
}

Range above_zero(double most) { return {0, most, true, false, ""}; }

/// Within a hundredth of what the mesh has, or refused.
void hold_to_liner(const char* option, const Value& given, double of_mesh, const char* what) {
  if (std::fabs(given.si - of_mesh) <= 0.01 * of_mesh) return;
  throw UserError(fmt::format("--{} {}: the liner's {} is {}; leave --{} out, or check --liner-unit", option, given.text, what,
                              millimetres(of_mesh, kMeshDigits), option));
}

void ask_for_liner(const Answer& answer, Mill& m, const host::Registry& registry) {
  std::string file;
  bool asks_unit = false;
  answer({"liner", "file with your liner (STEP, STL, OBJ, PLY, 3MF, …), empty for lifters of a simple shape", ""},
         [&](const std::string& text) {
           if (!text.empty() && !std::filesystem::exists(text))
             throw UserError(fmt::format("--liner {}: there is no such file; give the path of one", text));
           asks_unit = !text.empty() && !host::units_of(host::reader_of(text, registry)).empty();
           file = text;
         });
  if (file.empty()) return;
  const auto look = [&](const std::string& unit) { m.liner = look_at_liner(file, unit, registry); };
  if (!asks_unit) return look("");  // the file says it
  answer({"liner-unit", "unit in which it was drawn", "mm"}, look);
}

void ask_for_size(const Answer& answer, Mill& m) {
  const Question diameter{"diameter", "inner diameter of the bare shell",
                          m.liner ? millimetres(2 * m.liner->radius, kMeshDigits) : "300 mm"};
  answer(diameter, [&](const std::string& text) {
    m.diameter = read_value(diameter, text, "m", {0.01, 20, false, false, "mills are between 10 mm and 20 m wide"});
    if (m.liner) hold_to_liner("diameter", m.diameter, 2 * m.liner->radius, "diameter");
  });
  const Question bead{"bead-size", "diameter of the beads", millimetres(m.diameter.si / 60)};
  answer(bead, [&](const std::string& text) { m.bead = read_value(bead, text, "m", above_zero(0.5 * m.diameter.si)); });
  const bool walls = m.liner && (m.liner->wall_low || m.liner->wall_high);
  const Question ends{"ends", "a periodic slice, or closed with end faces that turn with the mill", walls ? "closed" : "periodic"};
  answer(ends, [&](const std::string& text) {
    m.closed = read_as_value(ends.option, text, [](const Node& node) { return config::read_choice(node, "periodic|closed"); }) == "closed";
    if (!m.closed && walls) throw UserError("--ends periodic: the liner has an end wall; take --ends closed, or a mesh without ends");
  });
  const double own = m.liner ? m.liner->high - m.liner->low : m.closed ? m.diameter.si : 4 * m.bead.si;
  const Question length{"length", m.closed ? "inner length of the mill" : "length of the slice",
                        millimetres(own, m.liner ? kMeshDigits : 2)};
  answer(length, [&](const std::string& text) {
    const Range range = m.closed
                            ? Range{m.bead.si, 50, false, false, "the mill holds one bead at least"}
                            : Range{kShortestSlice * m.bead.si, 50, false, false,
                                    "beads of a shorter slice meet their own images: take smaller beads, a longer slice or a longer liner"};
    m.length = read_value(length, text, "m", range);
    if (m.liner) hold_to_liner("length", m.length, own, "length");
  });
}

void ask_for_operation(const Answer& answer, Mill& m) {
  m.filling =
      ask_value(answer, {"filling", "part of the bare shell that the charge at rest takes, voids included", "30 %"}, "1", above_zero(1));
  m.critical_omega = critical_speed(m.diameter.si, m.bead.si);
  const Question speed{"speed", "speed of the mill", "75 %critical"};
  answer(speed, [&](const std::string& text) {
    const double omega = read_as_value(speed.option, text, [&](const Node& node) {
      const config::Quantity q = config::read_quantity(node);
      if (!q.has_unit || q.unit.dimension == config::Dimension{})
        node.fail(fmt::format("is '{}', without a unit of speed; write e.g. --speed \"75 %critical\" or --speed \"58 rpm\"", text));
      const bool critical = q.unit.dimension == config::parse_unit("%critical").dimension;
      return critical ? q.unit.to_si(q.number) * m.critical_omega : config::read_number(node, "rad/s");
    });
    if (!(omega > 0)) throw UserError(fmt::format("--speed {}: it must be above zero; the sense of turning is said by --direction", text));
    m.omega = omega;
    m.speed.text = text;
  });
  const Question direction{"direction",
                           "sense of turning, seen so that z points at you: counter_clockwise (the charge rises on the right) or clockwise",
                           "counter_clockwise"};
  m.clockwise = ask_choice(answer, direction, "counter_clockwise|clockwise") == "clockwise";
}

void ask_for_lifters(const Answer& answer, Mill& m) {
  const Question number{"lifters", "number of lifters, 0 for a smooth shell", "20"};
  answer(number, [&](const std::string& text) {
    m.lifters.number = static_cast<int>(
        read_as_value(number.option, text, [](const Node& node) { return config::read_integer(node, config::between(0, 1000)); }));
  });
  if (m.lifters.number == 0) return;
  const double d = m.diameter.si, pitch = std::numbers::pi * d / m.lifters.number;
  m.lifters.height = ask_value(answer, {"lifter-height", "height of a lifter", millimetres(d / 60)}, "m", above_zero(0.25 * d));
  m.lifters.width = ask_value(answer, {"lifter-width", "width of a lifter at its base", millimetres(std::min(d / 15, 0.5 * pitch))}, "m",
                              {0, pitch, true, true, "lifters must not overlap"});
  m.lifters.face_angle = ask_value(answer, {"lifter-angle", "angle between a lifter's face and its base", "60 deg"}, "rad",
                                   {0.35, std::numbers::pi / 2 + 1e-12, false, false, "20 to 90 deg"});
}

void ask_for_materials(const Answer& answer, Mill& m) {
  std::string known;
  for (const std::string& name : library_materials()) known += (known.empty() ? "" : ", ") + name;
  answer({"bead-material", fmt::format("material of the beads ({}, or a YAML file)", known), "glass"},
         [&](const std::string& text) { m.bead_material = find_material("--bead-material", text); });
  answer({"liner-material", "material of the liner", "hdpe"}, [&](const std::string& text) {
    m.liner_material = find_material("--liner-material", text);
    const Material& b = m.bead_material;
    const bool same = b.density == m.liner_material.density && b.young == m.liner_material.young && b.poisson == m.liner_material.poisson;
    if (b.name == m.liner_material.name && !same)
      throw UserError(
          fmt::format("--liner-material {}: another material is called '{}', too; give one of them another name", text, b.name));
  });
}

}  // namespace

Mill ask_for_mill(const Answer& answer, const host::Registry& registry) {
  Mill m;
  ask_for_liner(answer, m, registry);
  ask_for_size(answer, m);
  ask_for_operation(answer, m);
  if (!m.liner) ask_for_lifters(answer, m);
  ask_for_materials(answer, m);
  m.seconds = ask_value(
      answer, {"seconds", "how long to simulate (about four turns and a half are usual)", fmt::format("{:.6g} s", usual_seconds(m.omega))},
      "s", above_zero(1e6));
  return m;
}

}  // namespace millscope::new_mill
