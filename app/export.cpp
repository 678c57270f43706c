// export, import: a case for another engine, and what other engines made.
#include <fmt/core.h>

#include <filesystem>

#include "app/commands.hpp"
#include "app/engines.hpp"
#include "app/file_kinds.hpp"
#include "kernel/config/case.hpp"
#include "kernel/run/assembly.hpp"
#include "studies/engine/engine.hpp"
#include "studies/engine/liggghts/folder.hpp"
#include "studies/engine/liggghts/results.hpp"
#include "studies/frames/import.hpp"

namespace millscope::app {

namespace po = boost::program_options;

int export_case(const Arguments& arguments) {
  Options options(
      "export CASE.yaml -o FOLDER --engine liggghts",
      "Writes a case as another engine reads it: script, beads where millscope puts them, walls as STL, and a README. What that "
      "engine cannot play is refused, all of it at once.",
      "millscope export configs/demo.yaml -o demo-liggghts --engine liggghts");
  options.positional("CASE.yaml", "the case");
  options.add()("output,o", po::value<std::string>()->value_name("FOLDER"), "folder to make");
  add_engine(options);
  options.with_overrides();
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const config::Case c = config::read_case(options.text("CASE.yaml"), settings_of(options));
  if (c.run.engine.empty()) throw base::UserError("export: for which engine? Add --engine liggghts");
  engine::require_known(c);
  const host::Registry registry = options.registry();
  run::Assembly a = run::assemble(c, registry);
  const std::string folder = options.text("output");
  const engine::liggghts::Exported done = engine::liggghts::export_case(a, registry, folder);
  fmt::print("wrote {}: {} beads, {} meshes of {} triangles, {} steps; {}/README.md says how to run it\n", folder, done.beads, done.meshes,
             done.triangles, done.steps, folder);
  return kDone;
}

namespace {

int import_frames(const std::string& mill, const std::string& out, const host::Registry& registry) {
  const frames::Imported done = frames::import_frames(mill, out, registry, command_line);
  for (const std::string& note : done.notes) fmt::print("note: {}\n", note);
  const std::string followed = done.tracks > 0 ? fmt::format(", {} of them followed in tracks.h5", done.tracks) : "";
  fmt::print("wrote {}: {} beads{}, {} frame{} from {:.6g} s to {:.6g} s; see {}/summary.json\n", out, done.beads, followed, done.frames,
             done.frames == 1 ? "" : "s", done.from, done.until, out);
  return kDone;
}

}  // namespace

int import_case(const Arguments& arguments) {
  Options options(
      "import MILL.yaml|FOLDER -o OUT",
      "Makes a run of what another program simulated: frames.h5, series.csv, summary.json. analyze, compare and report take it. MILL.yaml "
      "names its frames (LIGGGHTS and LAMMPS dumps, EDEM exports and other tables, VTK; also gzipped) and says of the mill what they do "
      "not: docs/import.md. FOLDER is one that 'millscope export' made. What the program does not give is absent.",
      "millscope import mill.yaml -o theirs");
  options.positional("SOURCE", "mill.yaml, or a folder that 'millscope export' has made, after the other engine has run in it");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "folder to make");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const std::string out = options.text("output"), source = options.text("SOURCE");
  refuse_other_kind("MILL.yaml", source);
  if (!std::filesystem::is_directory(source)) return import_frames(source, out, options.registry());
  const engine::liggghts::Imported done = engine::liggghts::import_case(source, out, options.registry(), command_line);
  fmt::print("wrote {}: {} beads, {} frames, up to {:.4g} s; see {}/summary.json\n", out, done.beads, done.frames, done.until, out);
  return kDone;
}

}  // namespace millscope::app
