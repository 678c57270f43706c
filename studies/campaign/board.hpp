// What a campaign has to do and what has become of it: shared by the runners.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "studies/campaign/cache.hpp"
#include "studies/campaign/lock.hpp"
#include "studies/campaign/progress.hpp"

namespace millscope::campaign {

/// A simulation to compute; several of the caller's may be the same, and none where it is only another's donor.
struct Job {
  Entry entry;
  std::vector<std::size_t> indices;  ///< of the caller's simulations
  std::string donor;                 ///< key; "": it begins from a filling at rest
  double develop_s = 0;              ///< s, with a donor
  double work = 1;                   ///< as Identity::work
  double end_s = 0;                  ///< s
  std::uint64_t memory = 0;          ///< predicted, bytes
  int cores = 1;                     ///< as Identity::cores
  int attempts_before = 0;           ///< sessions before this call
  bool afresh = false;               ///< failed before and is to be tried again from its start
  double next_look = 0;              ///< s on the runner's clock: when to ask again for a lock that another head holds
};

class Board {
 public:
  /// Reads the cases, prepares their entries and settles what the cache knows already.
  Board(std::span<const Simulation> simulations, const Options& options);

  /// Jobs that nobody has finished yet, in the caller's order.
  std::deque<Job>& open() { return open_; }
  const Options& options() const { return options_; }
  ProgressLine& progress() { return progress_; }

  /// Key of the nearest donor that came to its end, "" where there is none; nothing while that is not settled.
  std::optional<std::string> donor_of(const Job& job) const;
  /// What another head has found meanwhile, or nothing.
  std::optional<TaskRecord> settled(const Job& job) const;
  /// Books the end of a job. `cached`: this call computed nothing for it.
  void finish(const Job& job, const TaskRecord& record, bool cached);
  /// Records a failure that the simulation itself could not record, and books it.
  void fail(const Job& job, const std::string& message);
  /// Outcomes in the caller's order, when all is finished.
  std::vector<Outcome> outcomes() && { return std::move(outcomes_); }
  std::string interrupted_message(const std::string& what_remains) const;

 private:
  void add(const Simulation& simulation, Identity id, std::optional<std::size_t> index);
  void settle(std::size_t index, const Outcome& outcome, double work);
  const Options& options_;
  const Identifier identifier_;
  std::map<std::string, std::size_t> places_;  ///< key → place in open_ when it was made
  std::map<std::string, std::string> donors_;  ///< key → its donor's, where it has one
  std::set<std::string> unsettled_, failed_;   ///< keys of jobs that are not finished; of simulations that failed
  std::vector<Identity> missing_;
  std::size_t found_ = 0;
  std::vector<Outcome> outcomes_;
  std::deque<Job> open_;
  ProgressLine progress_;
};

/// The lock of a job's entry, or nothing while another head holds it. A job that is to be tried again is brought to its start.
std::unique_ptr<Lock> take(const Job& job, const Board& board);

/// Runners: finish every open job of the board, or throw.
void run_here(Board& board);
void run_on_slurm(Board& board);

}  // namespace millscope::campaign
