// campaign, and campaign-task, which it starts.
#include "studies/campaign/campaign.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "studies/campaign/task.hpp"
#include "studies/campaign/tasks_file.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

campaign::Options campaign_options(const Options& options, const fs::path& output) {
  campaign::Options c = calibrate::campaign_of(study_session(options, output));
  if (c.cache.empty()) c.cache = output / "cache";
  if (options.has("memory")) {
    const double gigabytes = options.number("memory");
    if (!(gigabytes > 0 && gigabytes < 1e9)) throw UserError(fmt::format("--memory {}: give GB, more than 0", gigabytes));
    c.memory_bytes = static_cast<std::uint64_t>(gigabytes * 1e9);
  }
  if (options.has("poll")) {
    c.poll_s = options.number("poll");
    if (!(c.poll_s > 0)) throw UserError(fmt::format("--poll {}: give seconds, more than 0", c.poll_s));
  }
  return c;
}

void say(const campaign::Simulation& simulation, const campaign::Outcome& o) {
  const bool done = o.state == campaign::State::done;
  fmt::print("{:<20} {}\n", simulation.label,
             !done      ? "failed: " + o.message
             : o.cached ? "done already"
                        : fmt::format("done in {:.1f} s", o.wall_s));
  std::fflush(stdout);
}

int finish(const std::vector<campaign::Simulation>& simulations, const std::vector<campaign::Outcome>& outcomes, const fs::path& table,
           bool quiet) {
  std::size_t failed = 0, computed = 0;
  for (const campaign::Outcome& o : outcomes) {
    failed += o.state == campaign::State::failed ? 1 : 0;
    computed += o.cached ? 0 : 1;
  }
  if (failed == outcomes.size())
    throw UserError(fmt::format("all simulations failed, the first one ({}): {}", simulations[0].label, outcomes[0].message));
  if (!quiet) fmt::print("{} simulations, {} computed now, {} failed; see {}\n", outcomes.size(), computed, failed, table.string());
  return kDone;
}

}  // namespace

int run_campaign(const Arguments& arguments) {
  Options options("campaign TASKS.yaml -o OUT",
                  "Runs many simulations, one core each (another engine: run.ranks of them), and keeps their results: what has been "
                  "computed once is not computed again, what was "
                  "interrupted goes on, what failed is noted in campaign.csv. Particles are spheres.",
                  "millscope campaign configs/campaign.yaml -o campaign-out");
  options.positional("TASKS.yaml", "the simulations: cases with settings");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for campaign.csv and the cache; may exist");
  add_runner_options(options, "where results are kept (default: OUT/cache)");
  options.add()("memory", po::value<double>()->value_name("GB"), "that simulations may use together (default: what is free)");
  options.add()("poll", po::value<double>()->value_name("S"), "seconds between two looks at Slurm's queue (default: 5)");
  options.add()("plugin-dir", po::value<std::vector<std::string>>()->value_name("DIR"),
                "also load the plugins of this directory (may be repeated)");
  if (!options.parse(arguments)) return kDone;
  const std::string tasks = options.text("TASKS.yaml");
  const fs::path output = options.text("output");
  campaign::Options c = campaign_options(options, output);
  const std::vector<campaign::Simulation> simulations = campaign::read_tasks(tasks);
  std::vector<campaign::Outcome> outcomes(simulations.size());
  std::vector<bool> known(simulations.size());
  c.finished = [&](std::size_t index, const campaign::Outcome& outcome) {
    outcomes[index] = outcome;
    known[index] = true;
    if (!c.quiet) say(simulations[index], outcome);
  };
  fs::create_directories(output);
  const fs::path table = output / "campaign.csv";
  try {
    campaign::run(simulations, c);
  } catch (const UserError&) {
    campaign::write_table(table, simulations, outcomes, known);
    throw;
  }
  campaign::write_table(table, simulations, outcomes, known);
  return finish(simulations, outcomes, table, c.quiet);
}

int campaign_task(const Arguments& arguments) {
  Options options("campaign-task CACHE/KEY", "Runs one simulation of a campaign's cache; 'millscope campaign' starts it.",
                  "millscope campaign-task campaign-out/cache/0123456789abcdef0123456789abcdef");
  options.positional("CACHE/KEY", "the simulation's folder in the cache");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  host::RegistryOptions plugins;
  plugins.directories = options.list("plugin-dir");
  return campaign::perform(options.text("CACHE/KEY"), plugins);
}

}  // namespace millscope::app
