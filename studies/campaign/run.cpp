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
    : options_(options), identifier_(options), outcomes_(simulations.size()), progress_(options.quiet, simulations.size()) {
  make_directory(options.cache);
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    std::optional<Identity> id;
    try {
      id = identifier_.identify(simulations[i]);
    } catch (const base::UserError& e) {
      settle(i, {State::failed, {}, e.what(), true, 0, ""}, 0);
    }
    if (id) add(simulations[i], std::move(*id), i);
  }
  if (!options.say) return;
  if (found_ > 0) options.say(fmt::format("simulations found in the cache: {} of {}", found_, simulations.size()));
  if (!options.say_of_other_programs) return;
  if (const std::string others = other_programs_sentence(options.cache, missing_); !others.empty()) options.say(others);
}

/// `index`: of the caller's simulations; none for a donor of one that is to be computed: where it has failed, its own donor is needed.
void Board::add(const Simulation& simulation, Identity id, std::optional<std::size_t> index) {
  if (const auto same = places_.find(id.key); same != places_.end()) {
    if (index) open_[same->second].indices.push_back(*index);
    return;
  }
  const Entry entry(options_.cache, id.key);
  {
    const Guard guard(options_.cache);
    entry.prepare(id, simulation.label);
  }
  if (!id.donor.empty()) donors_[id.key] = id.donor;
  const TaskRecord record = entry.read();
  const bool failed = record.stage == Stage::failed, is_final = failed && !options_.retry_failed;
  if (is_final) failed_.insert(id.key);
  if (!id.donor.empty() && (is_final ? !index : record.stage != Stage::done) && !unsettled_.contains(id.donor)) {
    const Simulation& donor = *identifier_.donor_of(simulation).simulation;
    add(donor, identifier_.identify(donor), {});
  }
  if (record.stage == Stage::done || is_final) {
    if (!index) return;
    Outcome outcome = outcome_of(entry, record);
    outcome.cached = true;
    ++found_;
    return settle(*index, outcome, id.work);
  }
  places_.emplace(id.key, open_.size());
  unsettled_.insert(id.key);
  open_.push_back({entry, {}, id.donor, id.develop_s, id.work, id.end_s, id.memory, id.cores, record.attempts, failed, 0});
  if (index) open_.back().indices.push_back(*index);
  missing_.push_back(std::move(id));
}

std::optional<std::string> Board::donor_of(const Job& job) const {
  std::string key = job.donor;
  while (failed_.contains(key)) {
    const auto next = donors_.find(key);
    key = next == donors_.end() ? "" : next->second;
  }
  return unsettled_.contains(key) ? std::nullopt : std::optional(key);
}

std::optional<TaskRecord> Board::settled(const Job& job) const {
  const TaskRecord record = job.entry.read();
  const bool failed_anew = record.stage == Stage::failed && (!job.afresh || record.attempts > job.attempts_before);
  return record.stage == Stage::done || failed_anew ? std::optional(record) : std::nullopt;
}

void Board::finish(const Job& job, const TaskRecord& record, bool cached) {
  const std::string key = job.entry.folder().filename().string();
  unsettled_.erase(key);
  if (record.stage == Stage::failed) failed_.insert(key);
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
  if (!lock || board.settled(job)) return lock;
  if (!job.donor.empty()) job.entry.begin_from(board.donor_of(job).value(), job.develop_s);
  if (!job.afresh) return lock;
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
