// run, resume, check.
#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "app/commands.hpp"
#include "app/engines.hpp"
#include "app/watching.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/doubts.hpp"
#include "kernel/run/simulation.hpp"
#include "studies/engine/engine.hpp"
#include "studies/engine/liggghts/obstacles.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;

/// The first signal asks for a checkpoint and an orderly end; a second one kills as usual.
void on_signal(int signal) {
  run::request_stop();
  std::signal(signal, SIG_DFL);
}

void watch_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

void add_run_options(Options& options) {
  options.with_overrides();
  options.with_plugins();
  options.add()("threads", po::value<int>()->value_name("N"),
                "threads (default: run.threads of the case, else all cores); no influence on results");
  options.add()("quiet,q", "print nothing but errors");
}

run::RunOptions run_options(const Options& options) {
  run::RunOptions r;
  r.overrides = settings_of(options);
  r.command_line = command_line;
  r.quiet = options.has("quiet");
  r.terminal = isatty(STDERR_FILENO) != 0;
  if (options.has("threads")) {
    r.threads = options.integer("threads");
    if (r.threads < 1 || r.threads > 1024) throw base::UserError(fmt::format("--threads {}: give 1 to 1024", r.threads));
  }
  return r;
}

int report(run::Outcome outcome, const run::RunOptions& options) {
  if (outcome == run::Outcome::interrupted) return kInterrupted;
  if (options.quiet) return kDone;
  const std::filesystem::path summary = options.output / "summary.json";
  fmt::print("done; see {}\n", summary.string());
  for (const run::Doubt& doubt : run::doubts_in(output::read_json(summary))) fmt::print("doubt: {}\n", run::sentence_of(doubt));
  return kDone;
}

/// Throws base::UserError for what only this program knows, where another engine moves the beads.
void refuse_own_options(const Options& options) {
  for (const char* own : {"threads", "watch"}) {
    if (options.has(own))
      throw base::UserError(fmt::format("--{} is for runs of millscope itself; leave it out where another engine moves the beads", own));
  }
}

/// Whether another engine can play the case, and what it will do differently.
int check_for_engine(const config::Case& c, const host::Registry& registry) {
  engine::require_known(c);
  const run::Assembly a = run::assemble(c, registry);
  engine::liggghts::require_playable(a, registry);
  fmt::print("LIGGGHTS can play this case: {} beads, {} steps of {:.4g} s\n", a.bead_count, a.end_step - a.first_step, a.time_step);
  for (const std::string& difference : engine::liggghts::differences_of(a, registry)) fmt::print("differs: {}\n", difference);
  return kDone;
}

std::string bytes(std::uint64_t n) {
  if (n >= 10'000'000'000ULL) return fmt::format("{:.1f} GB", static_cast<double>(n) * 1e-9);
  return fmt::format("{:.1f} MB", static_cast<double>(n) * 1e-6);
}

}  // namespace

int run(const Arguments& arguments) {
  Options options(
      "run CASE.yaml -o OUT",
      "Simulates a case. Particles are spheres. Writes summary.json, series.csv, checkpoints and what the case asks for into OUT.",
      "millscope run configs/demo.yaml -o demo-out --threads 2");
  options.positional("CASE.yaml", "the case");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"),
                "directory to make; an existing run is never overwritten unless --force");
  options.add()("force", "overwrite an earlier run in OUT");
  options.add()("watch", "serve a page that follows the run, to this machine alone, and print its address");
  add_engine(options);
  options.add()("ranks", po::value<int>()->value_name("N"),
                "with --engine: processes that share the mill, through mpirun (default 1, or run.ranks of the case)");
  add_run_options(options);
  if (!options.parse(arguments)) return kDone;
  run::RunOptions r = run_options(options);
  const std::string case_file = options.text("CASE.yaml");
  r.output = options.text("output");
  r.force = options.has("force");
  if (!config::read_case(case_file, r.overrides).run.engine.empty()) refuse_own_options(options);
  if (options.has("watch")) watch_beside(r.output, options);
  watch_signals();
  return report(engine::run_case(case_file, options.registry(), r), r);
}

int resume(const Arguments& arguments) {
  Options options("resume OUT",
                  "Continues an interrupted run from its newest checkpoint, bit for bit, or a finished one to a later --set time.end_s=….",
                  "millscope resume demo-out --set time.end_s=3");
  options.positional("OUT", "directory of the run");
  options.add()("watch", "serve a page that follows the run, to this machine alone, and print its address");
  add_run_options(options);
  if (!options.parse(arguments)) return kDone;
  run::RunOptions r = run_options(options);
  r.output = options.text("OUT");
  if (engine::is_run(r.output)) refuse_own_options(options);
  if (options.has("watch")) watch_beside(r.output, options);
  watch_signals();
  return report(engine::resume_run(options.registry(), r), r);
}

int check(const Arguments& arguments) {
  Options options(
      "check CASE.yaml",
      "Checks a case without running it, and predicts beads, time step, steps, wall time, memory and disk from a trial of under a second.",
      "millscope check configs/demo.yaml");
  options.positional("CASE.yaml", "the case");
  add_run_options(options);
  add_engine(options);
  if (!options.parse(arguments)) return kDone;
  const config::Case c = config::read_case(options.text("CASE.yaml"), settings_of(options));
  if (!c.run.engine.empty()) return check_for_engine(c, options.registry());
  const run::Estimate e = run::estimate(options.text("CASE.yaml"), options.registry(), run_options(options));
  fmt::print("beads          {}  (spheres)\n", e.beads);
  fmt::print("time step      {:.4g} s, {:.0f} % of the Rayleigh time", e.time_step, 100 * e.rayleigh_fraction);
  if (e.contact_steps > 0) fmt::print(", {:.0f} steps in the shortest expected contact", e.contact_steps);
  fmt::print("\nsteps          {}\n", e.steps);
  fmt::print("slabs          {}  (run.partitions: so many threads can work at once)\n", e.partitions);
  fmt::print("wall time      about {:.0f} s at {:.1f} M particle-steps/s\n", e.wall_seconds, 1e-6 * e.particle_steps_per_s);
  fmt::print("memory         about {}\n", bytes(e.memory_bytes));
  fmt::print("disk           about {}\n", bytes(e.disk_bytes));
  return kDone;
}

}  // namespace millscope::app
