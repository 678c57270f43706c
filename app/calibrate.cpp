// calibrate, validate: from recordings to contact parameters, and whether they hold elsewhere.
#include <fmt/core.h>

#include <filesystem>
#include <sstream>

#include "app/commands.hpp"
#include "kernel/output/file.hpp"
#include "studies/calibrate/outputs.hpp"
#include "studies/calibrate/session.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using config::UserError;

void add_options(Options& options) {
  options.positional("STUDY.yaml", "base case, conditions with recordings, parameters, objective, method, budget");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for the results");
  options.add()("cache", po::value<std::string>()->value_name("DIR"), "where simulations are kept, each once (default: OUT/cache)");
  options.add()("runner", po::value<std::string>()->value_name("local|slurm"), "where simulations run (default: the study's)");
  options.add()("slots", po::value<int>()->value_name("N"), "simulations at once (default: as many as cores); no influence on results");
  options.add()("slurm", po::value<std::vector<std::string>>()->value_name("OPTIONS"), "more options for sbatch");
  options.add()("retry-failed", "run again what failed");
  options.add()("quiet,q", "print nothing but errors");
  options.with_overrides("replace a value of the study (may be repeated), e.g. --set budget.simulations=80");
  options.with_plugins();
}

calibrate::SessionOptions session_options(const Options& options, const fs::path& output) {
  calibrate::SessionOptions s;
  s.output = output;
  if (options.has("cache")) s.cache = options.text("cache");
  if (options.has("runner")) s.runner = options.text("runner");
  if (options.has("slots")) {
    s.slots = options.integer("slots");
    if (s.slots < 1) throw UserError(fmt::format("--slots {}: give 1 or more", s.slots));
  }
  for (const std::string& directory : options.list("plugin-dir")) s.plugin_directories.emplace_back(directory);
  for (const std::string& text : options.list("slurm")) {
    std::istringstream words(text);
    for (std::string word; words >> word;) s.slurm_options.push_back(word);
  }
  s.quiet = options.has("quiet");
  s.retry_failed = options.has("retry-failed");
  if (!s.quiet) {
    s.say = [](const std::string& line) {
      fmt::print("{}\n", line);
      std::fflush(stdout);
    };
  }
  return s;
}

void print_found(const calibrate::Study& study, const calibrate::Calibration& c, const fs::path& output) {
  fmt::print("\n{:<24} {:>10}   90 % interval\n", "parameter", "value");
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    fmt::print("{:<24} {:>10.4g}", study.parameters[p].name, c.best[static_cast<Eigen::Index>(p)]);
    if (c.inference) {
      const auto& m = c.inference->posterior.marginal[p];
      fmt::print("   {:.4g} … {:.4g}", m.low90, m.high90);
    }
    fmt::print("\n");
  }
  if (c.inference) {
    for (const auto& m : c.inference->posterior.marginal) fmt::print("{}\n", m.statement);
  }
  for (const std::string& note : c.notes) fmt::print("note: {}\n", note);
  fmt::print("results in {}: report.md, calibration.json, calibrated.yaml, runs.csv, pictures\n", output.string());
}

}  // namespace

int calibrate_study(const Arguments& arguments) {
  Options options("calibrate STUDY.yaml -o OUT",
                  "Finds the parameters of a case with which its simulations look like the recordings. Started again, it goes on where it "
                  "stopped and computes nothing twice.",
                  "millscope calibrate configs/chagas2015/study.yaml -o study-out");
  add_options(options);
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output");
  const calibrate::Study study = calibrate::read_study(options.text("STUDY.yaml"), options.list("set"));
  const host::Registry registry = options.registry();
  calibrate::Session session(study, registry, session_options(options, output));
  const calibrate::Calibration found = calibrate::calibrate(session.evaluator());
  calibrate::write_outputs(session.evaluator(), found, output);
  if (!options.has("quiet")) print_found(study, found, output);
  return kDone;
}

int validate(const Arguments& arguments) {
  Options options(
      "validate STUDY.yaml --calibration OUT/calibration.json -o OUT2",
      "Simulates the calibrated set in the conditions that were held out of the fit and judges every observable: difference with "
      "interval, pass or fail.",
      "millscope validate configs/chagas2015/study.yaml --calibration study-out/calibration.json -o validation-out");
  add_options(options);
  options.add()("calibration", po::value<std::string>()->value_name("FILE"), "calibration.json of 'millscope calibrate'");
  options.add()("all", "also the conditions that were fitted");
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output"), file = options.text("calibration");
  const calibrate::Study study = calibrate::read_study(options.text("STUDY.yaml"), options.list("set"));
  const Eigen::VectorXd point = calibrate::calibrated_set(file, study);
  std::vector<std::size_t> conditions = study.with_role(calibrate::Role::held_out);
  if (options.has("all")) {
    conditions = study.with_role(calibrate::Role::fit);
    for (const std::size_t c : study.with_role(calibrate::Role::held_out)) conditions.push_back(c);
  }
  if (conditions.empty())
    throw UserError(fmt::format("{}: no condition has 'role: held_out'; add one, or validate with --all", study.file.string()));
  const host::Registry registry = options.registry();
  calibrate::SessionOptions session_of = session_options(options, output);
  const fs::path beside = fs::absolute(file).parent_path() / "cache";
  if (session_of.cache.empty() && fs::exists(beside)) session_of.cache = beside;  // what calibrate simulated serves here, too
  calibrate::Session session(study, registry, session_of);
  const calibrate::Validation validation = calibrate::validate(session.evaluator(), point, conditions);
  calibrate::write_validation(validation, session.evaluator(), output);
  if (!options.has("quiet"))
    fmt::print("\n{}\nwritten to {}: validation.json, validation.md\n", calibrate::validation_text(validation, session.evaluator()),
               output.string());
  return kDone;
}

}  // namespace millscope::app
