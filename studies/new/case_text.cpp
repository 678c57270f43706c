// The text of a new case: every choice with its reason, so that its owner can change it.
#include <fmt/format.h>

#include <numbers>

#include "kernel/config/writer.hpp"
#include "studies/new/folder.hpp"
#include "studies/new/materials.hpp"

namespace millscope::new_mill {
namespace {

/// "# yaml-language-server: $schema=…", where the schema is installed. A file's address has no spaces.
std::string schema_line() {
  const auto schema = shared_file("case.schema.json");
  if (!schema) return "";
  std::string path = schema->string();
  if (path.find(' ') != std::string::npos) {
    std::string escaped = "file://";
    for (const char c : path) escaped += c == ' ' ? "%20" : std::string(1, c);
    path = escaped;
  }
  return fmt::format("# yaml-language-server: $schema={}\n", path);
}

std::string include_list(const Mill& m) {
  std::string list = fmt::format("materials/{}.yaml", m.bead_material.name);
  if (m.liner_material.name != m.bead_material.name) list += fmt::format(", materials/{}.yaml", m.liner_material.name);
  return list;
}

std::string pairs_text(const Mill& m) {
  const std::string &bead = m.bead_material.name, &liner = m.liner_material.name;
  std::string text =
      "pairs:                          # restitution: part of the closing speed that a bounce gives back; static_friction: Coulomb's "
      "coefficient\n";
  text += fmt::format("  {0}~{0}: {{restitution: 0.80, static_friction: 0.34}}\n", bead);
  if (liner != bead) text += fmt::format("  {}~{}: {{restitution: 0.55, static_friction: 0.30}}\n", bead, liner);
  return text;
}

std::string liner_text(const Mill& m) {
  const Liner& l = *m.liner;
  std::string text = fmt::format("geometry:\n  liner:\n    kind: {}\n    file: {}\n", l.kind, config::quoted(liner_name(l)));
  if (!l.unit.empty()) text += fmt::format("    unit: {}      # in which the file was drawn\n", l.unit);
  if (l.turned)
    text +=
        "    axis: auto                  # the file's axis is not z through the origin: found, turned and moved there\n    centre: true\n";
  if (!m.closed) text += fmt::format("    period: {:.6g}                # m: the mesh goes on along z as at its start\n", l.high - l.low);
  text +=
      fmt::format("    material: {}                # or one per solid of the file: materials: {{shell: …, lifter: …}}\n    motion: mill\n",
                  m.liner_material.name);
  const auto face = [&](const char* name, double z, int normal) {
    text += fmt::format(
        "  {}:                      # the mesh has no wall here: a flat face that turns with the mill\n    kind: plane\n"
        "    point: [0, 0, {:.6g}]\n    normal: [0, 0, {}]\n    size: {:.6g}\n    round: true                 # to look at: a plane is "
        "endless\n    material: {}\n    motion: mill\n",
        name, z, normal, 2 * l.radius, m.liner_material.name);
  };
  if (m.closed && !l.wall_low) face("end_low", l.low, 1);
  if (m.closed && !l.wall_high) face("end_high", l.high, -1);
  return text;
}

std::string mill_text(const Mill& m) {
  std::string text = fmt::format(
      "geometry:\n  liner:\n    kind: mill                  # 'millscope describe mill' has all parameters\n    diameter: {}\n    length: "
      "{}\n",
      m.diameter.text, m.length.text);
  if (m.closed) text += "    end_faces: true\n";
  text += fmt::format("    lifters: {}\n", m.lifters.number);
  if (m.lifters.number > 0) {
    text += fmt::format(
        "    lifter_height: {}\n    lifter_width: {}          # at the base\n    lifter_face_angle: {}     # between face and base\n",
        m.lifters.height.text, m.lifters.width.text, m.lifters.face_angle.text);
  }
  return text + fmt::format("    material: {}\n    motion: mill                # turns with the mill\n", m.liner_material.name);
}

}  // namespace

std::string case_text(const Mill& m, const Choices& c, const std::string& title) {
  const std::string bead = m.bead_material.name;
  std::string text = schema_line();
  text += fmt::format("# {}: {} beads of {}, about {} of them{}.\n#   millscope check case.yaml\n#   millscope run case.yaml -o out\n",
                      "A mill started by 'millscope new'", bead, m.bead.text, c.beads,
                      m.closed ? "" : ", in a slice that repeats along the axis");
  text += "# A number is SI or has a unit. Everything that may stand here: docs/cases.md; of plugins: millscope describe NAME.\n";
  text += fmt::format("schema_version: 1\nname: {}\ninclude: [{}]    # density and stiffness, with citations\n", config::quoted(title),
                      include_list(m));
  text += "seed: 1                         # of everything random: where beads are put, which are followed\n";
  text += fmt::format(
      "# Softened, so that steps can be longer: a bead that falls across the mill ({:.2g} m/s) sinks {:.0f} % of its effective radius in.\n"
      "# Up to 10 % hardly changes the motion; four times stiffer takes twice as long. Compare before you rely on it.\n"
      "stiffness_factor: {:.6g}\n\n",
      c.fastest, 100 * c.overlap, c.stiffness_factor);
  text += fmt::format("beads:\n  beads: {{material: {}, diameter: {}}}    # or several sizes: sizes: [{{diameter: …, fraction: …}}, …]\n\n",
                      bead, m.bead.text);
  text += fmt::format(
      "fill:\n  filling: {}                 # of the bare shell's volume, voids included; lifters are not subtracted\n"
      "  porosity: {}                # part of the bed at rest that is void\n  vessel: {{diameter: {}, length: {}}}\n"
      "  settle_s: {:.6g}                 # the charge falls this long with the mill at rest, before t = 0\n\n",
      m.filling.text, kPorosity, m.diameter.text, m.length.text, c.settle);
  text += "contact:\n  law: {kind: hertz_mindlin}\n\n";
  text +=
      "# Found for 5 mm glass beads on HDPE and nylon (Chagas 2015, UFRJ). For anything else a first guess: measure it, or find it from a\n"
      "# recording with 'millscope calibrate'.\n";
  text += pairs_text(m);
  text += "\nbody_forces:\n  gravity: {kind: gravity}\n\n";
  text += fmt::format(
      "mill:\n  diameter: {}              # critical speed is 42.3/sqrt(diameter - bead) rpm with both in m: {:.4g} rpm here\n"
      "  speed: {}\n  direction: {}\n\n",
      m.diameter.text, m.critical_omega * 30 / std::numbers::pi, m.speed.text, m.clockwise ? "clockwise" : "counter_clockwise");
  text += m.liner ? liner_text(m) : mill_text(m);
  if (!m.closed)
    text += fmt::format("\ndomain:\n  periodic: {{z: [{:.6g}, {:.6g}]}}      # m: what leaves the slice at one end comes in at the other\n",
                        m.low(), m.high());
  text += fmt::format(
      "\ntime:\n  end_s: {}\n  analyze_from_s: {:.6g}           # means are taken from here on; 'steady: false' in summary.json: begin "
      "later, run longer\n"
      "  step_fraction: 20 %           # of the Rayleigh time of the smallest bead; the usual choice\n\n",
      m.seconds.text, c.analyze_from);
  text += fmt::format(
      "output:\n  series: {{every_s: {:.6g}}}      # power, torque, energies over time\n"
      "  frames: {{every_s: {:.6g}}}      # all beads, for 'millscope analyze'\n"
      "  tracks: {{beads: 3, every_s: 0.0005}}      # three beads followed closely, as a tracer would be\n"
      "  vtk: {{every_s: {:.6g}}}         # pictures for ParaView\n",
      c.series_every, c.frames_every, c.pictures_every);
  return text;
}

std::string readme_text(const Mill& m, const Choices& c, const std::string& title) {
  std::string text = fmt::format(
      "# {}\n\n    millscope check case.yaml                # beads, time step, minutes, memory, disk; writes nothing\n"
      "    millscope run case.yaml -o out\n    millscope analyze out                    # maps, power, charge features: out-analysis/\n"
      "    millscope report out out-analysis        # one page to look at and to pass on: out/report.html\n\n",
      title);
  text +=
      fmt::format("{} of {}, {} {} beads (about {}), {} {}.\n", m.closed ? "A closed mill" : "A periodic slice of a mill", m.diameter.text,
                  m.bead.text, m.bead_material.name, c.beads, m.speed.text, m.clockwise ? "clockwise" : "counter-clockwise");
  text +=
      "\n| file | |\n|---|---|\n| `case.yaml` | the case; change it, every choice is explained there |\n"
      "| `materials/` | copies of the materials' properties, with citations |\n";
  if (m.liner)
    text += fmt::format("| `{}` | copy of the liner's file{} |\n", liner_name(*m.liner),
                        m.liner->unit.empty() ? "" : ", drawn in " + m.liner->unit);
  text +=
      "\nThe folder can be moved. `millscope run case.yaml -o slower --set mill.speed=\"60 %critical\"` changes one value for one run.\n";
  return text;
}

}  // namespace millscope::new_mill
