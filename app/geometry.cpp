// geometry export, geometry report.
#include <fmt/core.h>

#include <sstream>

#include "app/commands.hpp"
#include "app/file_kinds.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/geometry_file.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/stl.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
using base::UserError;

/// One geometry to look at, from a case or from a mesh file.
struct Named {
  std::string name;
  host::GeometryObject object;
};

std::vector<Named> from_case(const std::string& file, const std::vector<std::string>& overrides, const host::Registry& registry) {
  std::vector<Named> all;
  const config::Case c = config::read_case(file, overrides);
  for (const config::GeometryCase& g : c.geometry) {
    const host::Loaded& plugin = registry.find(Kind::geometry, g.plugin.kind, g.plugin.where);
    const config::ResolvedValues values = config::resolve(*plugin.descriptor, g.plugin.node, Scope::instance);
    all.push_back({g.plugin.name, host::GeometryObject::create(plugin, values.view(), g.plugin.where)});
  }
  if (all.empty()) throw UserError(file + ": the case has no geometry; add a section 'geometry'");
  return all;
}

std::vector<Named> load(const Options& options, const host::Registry& registry) {
  const std::string file = options.text("FILE");
  if (file.ends_with(".yaml") || file.ends_with(".yml")) return from_case(file, options.list("set"), registry);
  std::vector<Named> all;
  const bool asks = !host::units_of(host::reader_of(file, registry)).empty();
  const std::string unit = options.has("unit") ? options.text("unit") : asks ? "mm" : "";
  all.push_back({file, host::open_geometry({file, unit, "--unit", false}, registry)});
  return all;
}

std::vector<std::string> slots_of(const host::GeometryObject& g) {
  std::vector<std::string> slots;
  std::stringstream text(g.table().material_slots(g.self()));
  for (std::string slot; std::getline(text, slot, '|');) slots.push_back(slot);
  return slots;
}

int export_stl(const Options& options) {
  const std::string file = options.text("output");
  if (!options.has("force")) output::refuse_existing(file);
  const host::Registry registry = options.registry();
  const std::vector<Named> all = load(options, registry);
  const Named* chosen = &all.front();
  if (options.has("name")) {
    chosen = nullptr;
    for (const Named& n : all) {
      if (n.name == options.text("name")) chosen = &n;
    }
    if (chosen == nullptr) throw UserError(fmt::format("--name {}: the case has no geometry of that name", options.text("name")));
  } else if (all.size() > 1) {
    std::string names;
    for (const Named& n : all) names += " " + n.name;
    throw UserError("the case has several geometries:" + names + "; choose one with --name");
  }
  Surface surface{};
  chosen->object.table().surface(chosen->object.self(), &surface);
  if (surface.triangle_count == 0) throw UserError(fmt::format("geometry '{}' has no surface to export", chosen->name));
  output::write_stl(file, surface, slots_of(chosen->object), options.has("binary") ? output::StlFormat::binary : output::StlFormat::ascii);
  fmt::print("wrote {} ({} triangles, in metres)\n", file, surface.triangle_count);
  return kDone;
}

int report(const Options& options) {
  const host::Registry registry = options.registry();
  for (const Named& n : load(options, registry)) fmt::print("{}\n{}\n", n.name, n.object.table().report(n.object.self()));
  return kDone;
}

}  // namespace

int geometry(const Arguments& arguments) {
  Options options("geometry export|report FILE",
                  "Writes a geometry of a case as STL (solids named by material slot, in metres), or reports on a case's geometries, a "
                  "mesh file or a CAD file: "
                  "triangles, box, area, open edges, degenerate and duplicate faces, orientation.",
                  "millscope geometry export configs/crosscheck/slice_parametric.yaml -o liner.stl");
  options.positional("ACTION", "export or report");
  options.choices("ACTION", {"export", "report"});
  options.positional("FILE", "a case (.yaml), a mesh (STL, OBJ, …) or CAD bodies (STEP, IGES)");
  options.add()("output,o", po::value<std::string>()->value_name("FILE.stl"), "file to write");
  options.add()("force", "replace FILE.stl");
  options.add()("name", po::value<std::string>()->value_name("NAME"), "which geometry of the case");
  options.add()("binary", "write binary STL (names of solids are lost)");
  options.add()("unit", po::value<std::string>()->value_name("mm|cm|m|inch"),
                "unit of a mesh file (default: mm); STEP and IGES say theirs");
  options.with_overrides();
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const std::string action = options.text("ACTION");
  if (action == "export" || action == "report") {
    refuse_other_kind("CASE.yaml", options.text("FILE"));
    return action == "export" ? export_stl(options) : report(options);
  }
  throw UserError(fmt::format("geometry {}: the actions are 'export' and 'report'", action));
}

}  // namespace millscope::app
