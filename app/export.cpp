// export, import: a case for another engine, and what comes back.
#include <fmt/core.h>

#include "app/commands.hpp"
#include "app/engines.hpp"
#include "kernel/config/case.hpp"
#include "kernel/run/assembly.hpp"
#include "studies/engine/engine.hpp"
#include "studies/engine/liggghts/folder.hpp"
#include "studies/engine/liggghts/results.hpp"

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

int import_case(const Arguments& arguments) {
  Options options(
      "import FOLDER -o OUT",
      "Reads what another engine left in the folder of an exported case, and writes it as a run: frames.h5, series.csv, summary.json. "
      "analyze, compare and report take it. What that engine does not give is absent.",
      "millscope import demo-liggghts -o demo-theirs");
  options.positional("FOLDER", "folder that 'millscope export' has made, after the other engine has run in it");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "folder to make");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const std::string out = options.text("output");
  const engine::liggghts::Imported done = engine::liggghts::import_case(options.text("FOLDER"), out, options.registry(), command_line);
  fmt::print("wrote {}: {} beads, {} frames, up to {:.4g} s; see {}/summary.json\n", out, done.beads, done.frames, done.until, out);
  return kDone;
}

}  // namespace millscope::app
