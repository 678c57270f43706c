// crosscheck: does another engine say the same of a mill?
#include "studies/crosscheck/crosscheck.hpp"

#include <fmt/core.h>

#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/units.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;

/// "power=0.5 %", "centre=0.3 mm", "energy=1 %".
crosscheck::Limits limits_of(const std::vector<std::string>& texts) {
  crosscheck::Limits limits;
  const config::Node node = config::parse_document("{}", "--limit", texts);
  const config::Range above{0, 1e6, true, false, "a limit is above 0"};
  if (const auto power = node.find("power")) limits.power = config::read_number(*power, "", above);
  if (const auto centre = node.find("centre")) limits.centre = config::read_number(*centre, "m", above);
  if (const auto energy = node.find("energy")) limits.translation = config::read_number(*energy, "", above);
  node.finish();
  return limits;
}

void print_notes(const crosscheck::Found& found) {
  fmt::print("\nwhat {} defines in its own way:\n", found.engine_version.empty() ? found.engine : found.engine_version);
  for (const std::string& difference : found.differs) fmt::print("- {}\n", difference);
  for (const std::string& name : found.left_out) fmt::print("left out, for not every run tells it: {}\n", name);
}

}  // namespace

int crosscheck_engines(const Arguments& arguments) {
  Options options(
      "crosscheck CASE.yaml -o OUT",
      "Lets millscope and another engine play one case from the same beads at the same places, for several seeds, and tells in what they "
      "differ, each number with its error. Walls are the same triangles for both. Stopped, it goes on where it was.",
      "millscope crosscheck configs/story/mill.yaml -o story-crosscheck --seeds 6");
  options.positional("CASE.yaml", "the case");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for the runs and what they say");
  options.add()("engine", po::value<std::string>()->value_name("NAME"), "the other program (default: run.engine of the case, or liggghts)");
  options.add()("ranks", po::value<int>()->value_name("N"), "processes of the other program for each run, through mpirun (default: 1)");
  options.add()("seeds", po::value<int>()->value_name("N"), "starts, each played by both (default: 6); more make errors smaller");
  options.add()("switch", po::value<std::vector<std::string>>()->value_name("path.to.key=value"),
                "also run with this setting on millscope's side alone, and tell what it moves (may be repeated)");
  options.add()("limit", po::value<std::vector<std::string>>()->value_name("NAME=VALUE"),
                "how near is near enough (may be repeated): power=0.5 %, centre=0.3 mm, energy=1 %, which are the defaults");
  add_runner_options(options, "where the runs are kept (default: OUT/cache)");
  options.with_overrides();
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  crosscheck::Request request;
  request.case_file = options.text("CASE.yaml");
  request.settings = options.list("set");
  const config::RunCase own = config::read_case(request.case_file, request.settings).run;
  if (!own.engine.empty()) request.engine = own.engine, request.ranks = own.ranks;
  if (options.has("engine")) request.engine = options.text("engine");
  if (options.has("ranks")) request.ranks = options.integer("ranks");
  if (options.has("seeds")) request.seeds = options.integer("seeds");
  request.switches = options.list("switch");
  request.limits = limits_of(options.list("limit"));
  request.output = options.text("output");
  request.campaign = calibrate::campaign_of(study_session(options, request.output));
  const crosscheck::Found found = crosscheck::crosscheck(request, options.registry());
  crosscheck::write(found, request.output);
  if (!options.has("quiet")) {
    fmt::print("{}: {} seeds of {:.4g} s\n\n{}", found.name, found.seeds, found.window_s, crosscheck::table(found));
    print_notes(found);
    fmt::print("\n{}\nwritten to {}: crosscheck.json, quantities.csv\n", crosscheck::sentence(found), request.output.string());
  }
  return kDone;
}

}  // namespace millscope::app
