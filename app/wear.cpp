// wear: how a liner wears away in hours of running.
#include "studies/wear/wear.hpp"

#include <fmt/core.h>

#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/units.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;

double length_of(const Options& options, const char* name) {
  const config::Node node = config::parse_document("{}", std::string("--") + name, {std::string("value=") + options.text(name)});
  return config::read_number(*node.find("value"), "m", config::positive());
}

}  // namespace

int wear_liner(const Arguments& arguments) {
  Options options(
      "wear CASE.yaml --hours H -o OUT",
      "Wears a mill's liner away: simulates it, takes from its profile what the case's wear laws say for some hundred hours, "
      "smooths it and goes on with what is left, until the hours are over or the lifters are gone. Stopped, it goes on where it was.",
      "millscope wear configs/wear/case.yaml --hours 4000 --steps 8 -o wear-out");
  options.positional("CASE.yaml", "the case, with wear laws below contact.wear");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for the stages and what they say");
  options.add()("hours", po::value<double>()->value_name("H"), "hours of running");
  options.add()("steps", po::value<int>()->value_name("N"), "steps in which they pass (default: 8); more follow the shape better");
  options.add()("seeds", po::value<int>()->value_name("N"),
                "simulations of each stage, from other starts (default: 2); more make errors smaller");
  options.add()("body", po::value<std::string>()->value_name("NAME"), "the geometry that wears (default: the one that turns)");
  options.add()("pitches", po::value<int>()->value_name("N"), "how often the liner repeats in a turn (default: found out)");
  options.add()("rows", po::value<int>()->value_name("N"),
                "rows along the mill, each with a profile of its own (default: 1 for a slice, else one for two bead diameters)");
  options.add()("plate", po::value<std::string>()->value_name("LENGTH"),
                "metal behind the shell, e.g. \"40 mm\": when it is through, the study stops");
  options.add()("smooth", po::value<std::string>()->value_name("LENGTH"),
                "e.g. \"3 mm\": the loss is smoothed over it (default: the largest bead's radius)");
  add_runner_options(options, "where the simulations are kept, each once (default: OUT/cache)");
  options.with_overrides();
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  wear::Request request;
  request.case_file = options.text("CASE.yaml");
  request.settings = options.list("set");
  request.output = options.text("output");
  if (!options.has("hours")) throw base::UserError("wear: for how long? Add --hours, e.g. --hours 4000");
  request.hours = options.number("hours");
  if (options.has("steps")) request.steps = options.integer("steps");
  if (options.has("seeds")) request.seeds = options.integer("seeds");
  if (options.has("body")) request.body = options.text("body");
  if (options.has("pitches")) request.pitches = options.integer("pitches");
  if (options.has("rows")) request.rows = options.integer("rows");
  if (options.has("smooth")) request.smooth = length_of(options, "smooth");
  if (options.has("plate")) request.plate = length_of(options, "plate");
  request.campaign = calibrate::campaign_of(study_session(options, request.output));
  if (!options.has("quiet")) request.say = print_line;
  const wear::Found found = wear::wear(request, options.registry());
  wear::write(found, request);
  if (!options.has("quiet")) {
    fmt::print("\n{}: '{}' worn, {} pitches\n\n{}\nwritten to {}: wear.json, wear.csv, profiles.csv, pictures/, stages/, liner_NN.vtp\n",
               found.name, found.body, found.stages.front().profile.pitches, wear::table(found), request.output.string());
  }
  return kDone;
}

}  // namespace millscope::app
