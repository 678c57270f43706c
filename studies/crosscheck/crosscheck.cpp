#include "studies/crosscheck/crosscheck.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/parallel.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/assembly.hpp"
#include "studies/crosscheck/common_case.hpp"
#include "studies/engine/engine.hpp"

namespace millscope::crosscheck {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr int kFewestSeeds = 3, kMostSeeds = 1000;

std::vector<std::string> together(std::vector<std::string> first, const std::vector<std::string>& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

std::vector<std::string> of_engine(const Request& r) { return {"run.engine=" + r.engine, fmt::format("run.ranks={}", r.ranks)}; }

/// One who plays: the name that people read, and what is laid on the common case.
struct Player {
  std::string name;
  std::vector<std::string> settings;
};

std::vector<Player> players_of(const Request& r) {
  std::vector<Player> all{{r.engine, of_engine(r)}, {"millscope", {}}};  // the slower one first
  for (const std::string& setting : r.switches) all.push_back({"millscope, " + setting, {setting}});
  return all;
}

/// All runs of one seed behind each other, as `players_of` orders them.
std::vector<campaign::Simulation> simulations_of(const Request& r, const std::vector<Player>& players, const fs::path& case_file,
                                                 std::uint64_t first_seed) {
  std::vector<campaign::Simulation> all;
  for (int s = 0; s < r.seeds; ++s) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(s);
    for (const Player& player : players)
      all.push_back({case_file, together({fmt::format("seed={}", seed)}, player.settings), fmt::format("{}, seed {}", player.name, seed)});
  }
  return all;
}

void require_all(const std::vector<campaign::Simulation>& simulations, const std::vector<campaign::Outcome>& outcomes) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].state == campaign::State::failed)
      throw UserError(
          fmt::format("{}: {}; what is finished is kept, and --retry-failed tries again", simulations[i].label, outcomes[i].message));
  }
}

void tell_engine(Found& found, const fs::path& run) {
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  const auto engine = summary.is_object() ? summary.value("engine", nlohmann::ordered_json()) : nlohmann::ordered_json();
  if (!engine.is_object()) return;
  found.engine_version = engine.value("version", "");
  if (engine.contains("differs")) found.differs = engine["differs"].get<std::vector<std::string>>();
}

constexpr double kShortestWindow = 0.1;  // s: nine rows of 10 ms give the mean power of the other engine

void require_window(const config::Case& c) {
  if (c.time.end - c.time.analyze_from >= kShortestWindow) return;
  throw UserError(c.time.where, fmt::format("what counts is {:.4g} s, from time.analyze_from_s to time.end_s; give {} s and more",
                                            c.time.end - c.time.analyze_from, kShortestWindow));
}

void check(const Request& r) {
  if (r.engine.empty()) throw UserError("crosscheck: against which engine? Add --engine liggghts");
  if (r.seeds < kFewestSeeds || r.seeds > kMostSeeds)
    throw UserError(fmt::format("--seeds {}: give {} to {}; the error of a difference comes from them", r.seeds, kFewestSeeds, kMostSeeds));
}

}  // namespace

Found crosscheck(const Request& request, const host::Registry& registry) {
  check(request);
  config::Case c = config::read_case(request.case_file, together(request.settings, of_engine(request)));
  require_window(c);
  engine::require_playable(c, registry);
  const run::Assembly a = run::assemble(std::move(c), registry);
  for (const char* earlier : {"crosscheck.json", "quantities.csv"}) fs::remove(request.output / earlier);
  fs::create_directories(request.output / "common");
  const fs::path case_file = write_common_case(a, registry, request.output / "common");
  const std::vector<Player> players = players_of(request);
  for (const std::string& setting : request.switches) run::assemble(config::read_case(case_file.string(), {setting}), registry);
  const std::vector<campaign::Simulation> simulations = simulations_of(request, players, case_file, a.c.seed);
  campaign::Options options = request.campaign;
  if (options.cache.empty()) options.cache = request.output / "cache";
  const std::vector<campaign::Outcome> outcomes = campaign::run(simulations, options);
  require_all(simulations, outcomes);

  std::vector<std::vector<Quantity>> told(outcomes.size());
  base::for_each_item(outcomes.size(), base::worker_count(0, outcomes.size()),
                      [&](std::size_t i, std::size_t) { told[i] = measure(outcomes[i].folder, registry); });
  Found found;
  found.name = a.c.name, found.engine = request.engine, found.seeds = static_cast<std::size_t>(request.seeds);
  found.window_s = a.c.time.end - a.c.time.analyze_from;
  found.left_out = keep_common(told);
  tell_engine(found, outcomes[0].folder);
  const auto of_player = [&](std::size_t player) {
    std::vector<std::vector<Quantity>> runs;
    for (std::size_t i = player; i < told.size(); i += players.size()) runs.push_back(told[i]);
    return runs;
  };
  const auto theirs = of_player(0), ours = of_player(1);
  found.quantities = agreement(ours, theirs, request.limits);
  for (std::size_t k = 2; k < players.size(); ++k) {
    const auto switched = of_player(k);
    found.switches.push_back(
        {request.switches[k - 2], agreement(ours, switched, request.limits), agreement(switched, theirs, request.limits)});
  }
  for (std::size_t i = 0; i < outcomes.size(); ++i) found.runs.push_back({simulations[i].label, outcomes[i].folder, outcomes[i].wall_s});
  return found;
}

}  // namespace millscope::crosscheck
