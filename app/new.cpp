// new: a mill of one's own, from options or from answers.
#include <fmt/core.h>
#include <unistd.h>

#include <iostream>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "kernel/config/document.hpp"
#include "kernel/host/geometry_file.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/new_folder.hpp"
#include "studies/new/folder.hpp"
#include "studies/new/materials.hpp"
#include "studies/new/questions.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

void add_new_options(Options& options) {
  const auto value = [&options](const char* name, const char* shown, const char* what) {
    options.add()(name, po::value<std::string>()->value_name(shown), what);
  };
  value("diameter", "LENGTH", "inner diameter of the bare shell, with its unit (default: \"300 mm\", or the liner's)");
  value("length", "LENGTH", "inner length; of a slice, how much of it (default: four beads; closed: the diameter; or the liner's)");
  value("ends", "periodic|closed", "a slice that repeats along the axis, or end faces that turn with the mill (default: periodic)");
  value("filling", "PERCENT", "part of the bare shell that the charge at rest takes (default: \"30 %\")");
  value("bead-size", "LENGTH", "diameter of the beads (default: a sixtieth of the mill's)");
  value("speed", "SPEED", "with its unit (default: \"75 %critical\")");
  value("direction", "counter_clockwise|clockwise", "sense of turning (default: counter_clockwise)");
  value("liner", "FILE", "your liner: STEP, IGES, STL, OBJ, PLY, OFF, glTF, GLB, 3MF");
  value("liner-unit", "mm|m|cm|inch", "unit in which a mesh was drawn (STEP and IGES say theirs)");
  value("lifters", "N", "without a liner file: number of lifters, 0 for a smooth shell (default: 20)");
  value("lifter-height", "LENGTH", "(default: a sixtieth of the diameter)");
  value("lifter-width", "LENGTH", "at the base (default: a fifteenth of the diameter)");
  value("lifter-angle", "ANGLE", "between face and base (default: \"60 deg\")");
  value("bead-material", "NAME", "of the library, or a YAML file with one (default: glass)");
  value("liner-material", "NAME", "of the library, or a YAML file with one (default: hdpe)");
  value("seconds", "TIME", "how long to simulate (default: four turns and a half)");
  if (table_being_written() != nullptr) {  // the library is looked up only where its names are wanted
    options.choices("bead-material", new_mill::library_materials());
    options.choices("liner-material", new_mill::library_materials());
  }
  options.add()("yes,y", "ask nothing; take the defaults for what is not given");
  options.with_plugins();
}

/// Options without effect would be a mistake that nobody sees.
void refuse_needless(const Options& options, const host::Registry& registry) {
  if (options.has("liner")) {
    const bool says_unit = host::units_of(host::reader_of(options.text("liner"), registry)).empty();
    if (says_unit && options.has("liner-unit"))
      throw UserError(fmt::format("--liner-unit: {} says its unit itself; leave --liner-unit out", options.text("liner")));
    for (const char* name : {"lifters", "lifter-height", "lifter-width", "lifter-angle"}) {
      if (options.has(name))
        throw UserError(fmt::format("--{}: the lifters are in the liner's file; leave --{} or --liner out", name, name));
    }
  } else if (options.has("liner-unit")) {
    throw UserError("--liner-unit: there is no --liner; give its file, or leave the unit out");
  }
  if (options.has("lifters") && options.text("lifters") == "0") {
    for (const char* name : {"lifter-height", "lifter-width", "lifter-angle"}) {
      if (options.has(name)) throw UserError(fmt::format("--{}: there are no lifters; leave it out, or give --lifters", name));
    }
  }
}

/// Asks until the answer can be taken; an empty line takes the default.
void ask_person(const new_mill::Question& q, const std::function<void(const std::string&)>& take) {
  for (;;) {
    fmt::print("{}{}: ", q.text, q.standard.empty() ? "" : " [" + q.standard + "]");
    std::fflush(stdout);
    std::string line;
    if (!std::getline(std::cin, line)) throw UserError("the answers ended before all was asked; nothing was written; --yes takes defaults");
    const std::size_t first = line.find_first_not_of(" \t"), last = line.find_last_not_of(" \t");
    line = first == std::string::npos ? q.standard : line.substr(first, last - first + 1);
    try {
      return take(line);
    } catch (const UserError& e) {
      fmt::print("  {}\n", e.what());
    }
  }
}

new_mill::Answer answers_of(const Options& options, bool asking) {
  return [&options, asking](const new_mill::Question& q, const std::function<void(const std::string&)>& take) {
    if (options.has(q.option)) return take(options.text(q.option));
    // With an option that decides it, a question is none: lifters were named, or everything is taken as it is.
    const bool decided = q.option == "liner" && options.has("lifters");
    if (q.option == "liner-unit" && !asking)
      throw UserError("--liner-unit is missing: meshes carry no unit; give mm, cm, m or inch, in which the liner was drawn");
    if (asking && !decided) return ask_person(q, take);
    take(q.standard);
  };
}

}  // namespace

int new_mill(const Arguments& arguments) {
  Options options(
      "new FOLDER",
      "Starts a mill of your own: writes FOLDER with a commented case.yaml that passes 'millscope check', the materials and liner "
      "that it needs, and a README.md of what to do next. On a terminal it asks for what no option says.",
      "millscope new my_mill --diameter \"300 mm\" --bead-size \"5 mm\" --filling \"30 %\" --speed \"75 %critical\" --yes");
  options.positional("FOLDER", "to be made; its last name is the mill's");
  add_new_options(options);
  if (!options.parse(arguments)) return kDone;
  const fs::path folder = output::without_end_slash(options.text("FOLDER"));
  if (folder.empty() || folder.filename() == "." || folder.filename() == "..")
    throw UserError(fmt::format("'{}' names no new folder; give a name, e.g. my_mill", options.text("FOLDER")));
  output::refuse_folder(folder);
  const host::Registry registry = options.registry();
  refuse_needless(options, registry);
  const bool asking = !options.has("yes") && isatty(STDIN_FILENO) != 0;
  const new_mill::Mill mill = new_mill::ask_for_mill(answers_of(options, asking), registry);
  const new_mill::Choices choices = new_mill::choose(mill);
  const new_mill::Found found = new_mill::write_folder(folder, mill, choices, registry);
  for (const std::string& warning : new_mill::warnings(mill, choices)) fmt::print(stderr, "millscope: warning: {}\n", warning);
  fmt::print("wrote {0}: case.yaml, README.md, materials/{1}\n", folder.string(),
             mill.liner ? ", " + new_mill::liner_name(*mill.liner) : "");
  fmt::print("beads          {}  (spheres)\nsteps          {} of {:.3g} s\n", found.beads, found.steps, found.time_step);
  if (found.wall_seconds > 0) fmt::print("wall time      about {:.0f} s on this machine\n", found.wall_seconds);
  fmt::print("next:\n  millscope check {0}\n  millscope run {0} -o {1}\n", (folder / "case.yaml").string(), (folder / "out").string());
  return kDone;
}

}  // namespace millscope::app
