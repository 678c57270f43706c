#include "app/study_options.hpp"

#include <fmt/core.h>

#include <sstream>

namespace millscope::app {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

void add_runner_options(Options& options, const char* cache) {
  options.add()("cache", po::value<std::string>()->value_name("DIR"), cache);
  options.add()("runner", po::value<std::string>()->value_name("local|slurm"), "where simulations run (default: local, or the study's)");
  options.add()("slots", po::value<int>()->value_name("N"),
                "cores at once (default: all of this machine; slurm: no limit, or of each array); no influence on results");
  options.add()("slurm", po::value<std::vector<std::string>>()->value_name("OPTIONS"),
                "more options for sbatch, e.g. --slurm=\"--partition=long --time=2:00:00\"");
  options.add()("retry-failed", "run again what failed");
  options.add()("quiet,q", "print nothing but errors");
}

void add_study_options(Options& options) {
  options.positional("STUDY.yaml", "base case, conditions with recordings, parameters, objective, method, budget");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for the results");
  add_runner_options(options, "where simulations are kept, each once (default: OUT/cache)");
  options.with_overrides("replace a value of the study (may be repeated), e.g. --set budget.simulations=80");
  options.with_plugins();
}

void add_draws_option(Options& options) {
  options.add()("draws", po::value<int>()->value_name("N"),
                "pseudo-recordings behind every p-value (default: 2016, or as many as the study's level asks for)");
}

int draws_of(const Options& options) {
  if (!options.has("draws")) return 0;
  const int draws = options.integer("draws");
  if (draws < 100) throw base::UserError(fmt::format("--draws {}: give 100 or more", draws));
  return draws;
}

std::vector<std::string> words_of(const std::vector<std::string>& texts) {
  std::vector<std::string> words;
  for (const std::string& text : texts) {
    std::istringstream in(text);
    for (std::string word; in >> word;) words.push_back(word);
  }
  return words;
}

calibrate::SessionOptions study_session(const Options& options, const fs::path& output) {
  calibrate::SessionOptions s;
  s.output = output;
  if (options.has("cache")) s.cache = options.text("cache");
  if (options.has("runner")) s.runner = options.text("runner");
  if (options.has("slots")) {
    s.slots = options.integer("slots");
    if (s.slots < 1) throw UserError(fmt::format("--slots {}: give 1 or more", s.slots));
  }
  for (const std::string& directory : options.list("plugin-dir")) s.plugin_directories.emplace_back(directory);
  s.slurm_options = words_of(options.list("slurm"));
  s.quiet = options.has("quiet");
  s.retry_failed = options.has("retry-failed");
  if (!s.quiet) s.say = print_line;
  return s;
}

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace millscope::app
