// bank: the simulations that a diagnosis is answered from, looked at and run apart from it.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "app/actions.hpp"
#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "kernel/config/document.hpp"
#include "studies/diagnose/bank/bank_status.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

/// The study's overrides, and the study itself in the place of every recording that is not there yet: a bank depends on none.
std::vector<std::string> without_recordings(const std::string& study, std::vector<std::string> overrides) {
  const config::Node root = config::load_document_with_paths(study, overrides);
  const auto conditions = root.find("conditions");
  if (!conditions || !conditions->is_map()) return overrides;  // the reader says it
  for (const std::string& name : conditions->keys()) {
    const auto condition = conditions->find(name);
    if (!condition->is_map()) continue;
    const bool missing = !condition->has("recording") || !fs::exists(config::resolve_file(condition->at("recording")));
    if (missing) overrides.push_back(fmt::format("conditions.{}.recording={}", name, fs::absolute(study).string()));
  }
  return overrides;
}

fs::path cache_of(const Options& options) {
  if (options.has("cache")) return options.text("cache");
  if (options.has("output")) return fs::path(options.text("output")) / "cache";
  throw UserError("--cache is missing; give that of 'millscope diagnose', or its OUT as -o OUT");
}

void add_bank_options(Options& options) {
  options.positional("STUDY.yaml", "study of 'millscope diagnose'; its recordings need not be there");
  options.add()("cache", po::value<std::string>()->value_name("DIR"), "where simulations are kept (default: OUT/cache)");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "OUT of the diagnosis");
  options.add()("slots", po::value<int>()->value_name("N"), "simulations at once (default: as many as cores)");
  options.with_overrides("replace a value of the study (may be repeated), e.g. --set bank.each=14");
  options.with_plugins();
}

campaign::Options bank_campaign(const Options& options) {
  campaign::Options c = calibrate::campaign_of(study_session(options, ""));
  c.cache = cache_of(options);
  return c;
}

diagnose::Question question_of(const Options& options) {
  const std::string study = options.text("STUDY.yaml");
  return diagnose::read_question(study, without_recordings(study, options.list("set")), options.registry());
}

int status(const Arguments& arguments) {
  Options options("bank status STUDY.yaml --cache DIR",
                  "Lists what of a diagnosis' simulations is in the cache, by candidate and condition, and how long the rest will take. "
                  "Starts nothing.",
                  "millscope bank status configs/mill10/diagnose.yaml --cache diagnosis/cache");
  add_bank_options(options);
  if (!options.parse(arguments)) return kDone;
  const campaign::Options c = bank_campaign(options);
  const int slots = c.slots > 0 ? c.slots : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const diagnose::Question question = question_of(options);
  fmt::print("{}", diagnose::status_text(question, diagnose::bank_status(question, c), slots));
  return kDone;
}

int extend(const Arguments& arguments) {
  Options options(
      "bank extend STUDY.yaml --cache DIR",
      "Runs the simulations of a diagnosis that the cache does not have yet, without diagnosing: all candidates in the fitted "
      "conditions, in those held out what has no candidate, and all where that is too little. Started again, it goes on where it stopped.",
      "millscope bank extend configs/mill10/diagnose.yaml --cache diagnosis/cache");
  add_bank_options(options);
  options.add()("runner", po::value<std::string>()->value_name("local|slurm"), "where simulations run (default: the study's)");
  options.add()("slurm", po::value<std::vector<std::string>>()->value_name("OPTIONS"), "more options for sbatch");
  options.add()("retry-failed", "run again what failed");
  options.add()("quiet,q", "print nothing but errors");
  if (!options.parse(arguments)) return kDone;
  campaign::Options c = bank_campaign(options);
  const diagnose::Question question = question_of(options);
  if (!options.has("runner")) c.runner = question.study.runner;
  std::vector<campaign::Simulation> simulations;
  for (const diagnose::PlannedRun& run : diagnose::planned_runs(question)) simulations.push_back(run.simulation);
  std::size_t computed = 0, failed = 0;
  std::string first;
  for (const campaign::Outcome& o : campaign::run(simulations, c)) {
    computed += o.cached ? 0 : 1;
    if (o.state == campaign::State::failed && failed++ == 0) first = o.message;
  }
  if (failed == simulations.size()) throw UserError(fmt::format("all simulations of the bank failed, the first one: {}", first));
  if (!c.quiet) fmt::print("{} simulations in {}, {} computed now, {} failed\n", simulations.size(), c.cache.string(), computed, failed);
  return kDone;
}

constexpr Action kBankActions[] = {
    {"status", "what is in the cache, and how long the rest will take", status},
    {"extend", "run what is missing", extend},
};

}  // namespace

int bank(const Arguments& arguments) {
  return call_action({"bank", "The simulations that a diagnosis is answered from, looked at and run apart from it.", kBankActions,
                      "millscope bank status configs/mill10/diagnose.yaml --cache diagnosis/cache"},
                     arguments);
}

}  // namespace millscope::app
