#include <fmt/format.h>

#include <map>

#include "studies/campaign/board.hpp"
#include "studies/campaign/reuse.hpp"

namespace millscope::campaign {
namespace {

void check(const Options& options) {
  if (options.cache.empty()) throw base::UserError("campaign: no directory for the cache is given");
  if (options.runner != "local" && options.runner != "slurm")
    throw base::UserError(fmt::format("runner '{}': give local or slurm", options.runner));
  if (options.slots < 0) throw base::UserError(fmt::format("slots {}: give 1 or more, or 0 for as many as there are cores", options.slots));
}

Options with_absolute_paths(Options options) {
  options.cache = std::filesystem::absolute(options.cache).lexically_normal();
  for (std::filesystem::path& directory : options.plugin_directories) directory = std::filesystem::absolute(directory);
  return options;
}

}  // namespace

Board::Board(std::span<const Simulation> simulations, const Options& options)
    : options_(options), outcomes_(simulations.size()), progress_(options.quiet, simulations.size()) {
  make_directory(options.cache);
  const Identifier identifier(options);
  std::map<std::string, std::size_t> places;  // key → place in open_
  std::vector<Identity> missing;
  std::size_t found = 0;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    Identity id;
    try {
      id = identifier.identify(simulations[i]);
    } catch (const base::UserError& e) {
      settle(i, {State::failed, {}, e.what(), true, 0, ""}, 0);
      continue;
    }
    if (const auto same = places.find(id.key); same != places.end()) {
      open_[same->second].indices.push_back(i);
      continue;
    }
    const Entry entry(options.cache, id.key);
    {
      const Guard guard(options.cache);
      entry.prepare(id, simulations[i].label);
    }
    const TaskRecord record = entry.read();
    const bool failed = record.stage == Stage::failed;
    if (record.stage == Stage::done || (failed && !options.retry_failed)) {
      Outcome outcome = outcome_of(entry, record);
      outcome.cached = true;
      ++found;
      settle(i, outcome, id.work);
      continue;
    }
    places.emplace(id.key, open_.size());
    open_.push_back({entry, {i}, id.work, id.end_s, id.memory, record.attempts, failed, 0});
    missing.push_back(std::move(id));
  }
  if (!options.say) return;
  if (found > 0) options.say(fmt::format("simulations found in the cache: {} of {}", found, simulations.size()));
  if (!options.say_of_other_programs) return;
  if (const std::string others = other_programs_sentence(options.cache, missing); !others.empty()) options.say(others);
}

std::optional<TaskRecord> Board::settled(const Job& job) const {
  const TaskRecord record = job.entry.read();
  const bool failed_anew = record.stage == Stage::failed && (!job.afresh || record.attempts > job.attempts_before);
  return record.stage == Stage::done || failed_anew ? std::optional(record) : std::nullopt;
}

void Board::finish(const Job& job, const TaskRecord& record, bool cached) {
  Outcome outcome = outcome_of(job.entry, record);
  for (const std::size_t index : job.indices) {
    outcome.cached = cached || index != job.indices.front();
    settle(index, outcome, job.work);
  }
}

void Board::fail(const Job& job, const std::string& message) {
  TaskRecord record = job.entry.read();
  record.stage = Stage::failed;
  record.message = message;
  job.entry.write(record);
  finish(job, record, false);
}

void Board::settle(std::size_t index, const Outcome& outcome, double work) {
  outcomes_[index] = outcome;
  progress_.count(outcome.state == State::done, outcome.cached, work, outcome.wall_s);
  if (options_.finished) {
    progress_.clear();
    options_.finished(index, outcome);
  }
}

std::string Board::interrupted_message(const std::string& what_remains) const {
  return fmt::format("stopped: {}; {}; the same command goes on from there", progress_.counts(), what_remains);
}

std::unique_ptr<Lock> take(const Job& job, const Board& board) {
  std::unique_ptr<Lock> lock = Lock::try_take(board.options().cache, job.entry.folder() / "lock");
  if (!lock || !job.afresh || board.settled(job)) return lock;
  TaskRecord record = job.entry.read();
  if (record.stage != Stage::failed) return lock;
  std::filesystem::remove_all(job.entry.run());
  record.stage = Stage::waiting;
  record.message.clear();
  job.entry.write(record);
  return lock;
}

std::vector<Outcome> run(std::span<const Simulation> simulations, const Options& given) {
  check(given);
  const Options options = with_absolute_paths(given);
  Board board(simulations, options);
  if (!board.open().empty()) options.runner == "slurm" ? run_on_slurm(board) : run_here(board);
  board.progress().clear();
  return std::move(board).outcomes();
}

}  // namespace millscope::campaign
