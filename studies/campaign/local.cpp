// The simulations of a campaign on this machine: one process of one thread each, or as many as another engine has ranks.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <list>
#include <map>
#include <thread>

#include "kernel/output/child.hpp"
#include "kernel/output/file.hpp"
#include "studies/campaign/board.hpp"
#include "studies/campaign/memory.hpp"
#include "studies/campaign/signals.hpp"
#include "studies/campaign/task.hpp"

namespace millscope::campaign {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFruitless = 3;       // stops without a newer checkpoint, before a simulation counts as failed
constexpr double kLookEvery = 0.5;  // s between two looks at what another head holds
constexpr auto kBreath = std::chrono::milliseconds(10);

struct Running {
  Job job;
  std::unique_ptr<Lock> lock;
  std::int64_t checkpoint;  ///< when it was started
  std::unique_ptr<output::Child> child;
};

class Local {
 public:
  explicit Local(Board& board) : board_(board), slots_(board.options().slots > 0 ? board.options().slots : available_cores()) {}

  void run() {
    while (!board_.open().empty() || !running_.empty()) {
      if (signals_.arrived() || !trouble_.empty()) stop();
      reap();
      if (!stopping_) fill();
      if (stopping_ && running_.empty()) break;
      report();
      std::this_thread::sleep_for(kBreath);
    }
    if (!trouble_.empty()) throw base::UserError(trouble_, trouble_code_);
    if (stopping_ && !board_.open().empty())
      throw Interrupted(board_.interrupted_message("the runs under way have written their checkpoints"));
  }

 private:
  void stop() {
    stopping_ = true;
    for (Running& r : running_) r.child->ask_to_stop();
  }

  void reap() {
    for (auto r = running_.begin(); r != running_.end();) {
      r->lock->keep_alive();
      const std::optional<output::Ended> ended = r->child->poll();
      if (!ended) {
        ++r;
        continue;
      }
      Running gone = std::move(*r);
      r = running_.erase(r);
      settle(gone, *ended);
    }
  }

  void settle(Running& r, const output::Ended& ended) {
    const std::optional<TaskRecord> record = board_.settled(r.job);
    if (record) return board_.finish(r.job, *record, false);
    if (ended.signal == 0 && (ended.exit_code == output::kExitDisk || ended.exit_code == output::kCannotStart)) {
      trouble_ = ended.exit_code == output::kCannotStart ? fmt::format("{}: cannot be started; give the millscope program", program())
                                                         : last_line(r.job.entry.messages());
      trouble_code_ = ended.exit_code == output::kCannotStart ? base::kExitBadInput : output::kExitDisk;
      return give_back(r.job, 0);
    }
    if (ended.signal == 0 && ended.exit_code == kBusy) return give_back(r.job, kLookEvery);
    const bool asked = ended.signal == SIGTERM || ended.signal == SIGINT;  // came before the simulation listened
    const bool stopped = asked || (ended.signal == 0 && ended.exit_code == kInterruptedCode);
    if (stopped || (stopping_ && ended.signal != 0)) {
      const bool further = stopping_ || r.job.entry.checkpoint_time() != r.checkpoint;
      int& fruitless = fruitless_[r.job.entry.folder().string()];
      fruitless = further ? 0 : fruitless + 1;
      if (fruitless < kFruitless) return give_back(r.job, 0);
    }
    board_.fail(r.job, reason(r, ended));
  }

  std::string reason(const Running& r, const output::Ended& ended) const {
    const std::string said = last_line(r.job.entry.messages()), tail = said.empty() ? "" : fmt::format("; its last words: {}", said);
    if (ended.signal == SIGKILL) return "killed from outside (SIGKILL: out of memory?)" + tail;
    if (ended.signal != 0) return fmt::format("crashed: {}{}", ::strsignal(ended.signal), tail);
    if (ended.exit_code == kInterruptedCode) return fmt::format("stopped from outside {} times before a checkpoint", kFruitless);
    return said.empty() ? fmt::format("ended with code {} and said nothing", ended.exit_code) : said;
  }

  void give_back(Job job, double pause) {
    job.next_look = now() + pause;
    board_.open().push_front(std::move(job));
  }

  void fill() {
    std::deque<Job>& open = board_.open();
    for (auto job = open.begin(); job != open.end() && cores_in_use() < slots_;) {
      if (job->next_look > now() || !board_.donor_of(*job)) {
        ++job;
        continue;
      }
      if (!fits(*job)) return;
      std::unique_ptr<Lock> lock = take(*job, board_);
      const std::optional<TaskRecord> record = board_.settled(*job);
      if (!lock && !record) {
        job->next_look = now() + kLookEvery;
        ++job;
        continue;
      }
      const Job taken = *job;
      job = open.erase(job);
      if (record) {
        board_.finish(taken, *record, true);
      } else {
        start(taken, std::move(lock));
      }
    }
  }

  void start(const Job& job, std::unique_ptr<Lock> lock) {
    std::vector<std::string> command{program(), "campaign-task", job.entry.folder().string()};
    for (const std::filesystem::path& directory : board_.options().plugin_directories) {
      command.insert(command.end(), {"--plugin-dir", directory.string()});
    }
    auto child = std::make_unique<output::Child>(command, job.entry.messages());
    running_.push_back({job, std::move(lock), job.entry.checkpoint_time(), std::move(child)});
  }

  std::string program() const { return board_.options().program.empty() ? output::own_program() : board_.options().program.string(); }

  int cores_in_use() const {
    int cores = 0;
    for (const Running& r : running_) cores += r.job.cores;
    return cores;
  }

  /// One simulation always may run, however much it needs.
  bool fits(const Job& job) const {
    if (running_.empty()) return true;
    if (cores_in_use() + job.cores > slots_) return false;
    std::uint64_t promised = 0, all = job.memory;
    for (const Running& r : running_) {
      const std::uint64_t held = r.child->resident();
      promised += r.job.memory - std::min(held, r.job.memory);
      all += r.job.memory;
    }
    if (board_.options().memory_bytes > 0) return all <= board_.options().memory_bytes;
    return promised + job.memory <= available_memory();
  }

  void report() {
    if (!board_.progress().due()) return;
    std::vector<Underway> underway;
    double waiting = 0;
    for (const Running& r : running_) {
      underway.push_back({r.job.work, r.child->elapsed(), std::min(1.0, simulated_time(r.job.entry.run()) / r.job.end_s)});
    }
    for (const Job& job : board_.open()) waiting += job.work * job.cores;
    board_.progress().update(underway, waiting, slots_);
  }

  double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Board& board_;
  int slots_;
  StopSignals signals_;
  std::list<Running> running_;
  std::map<std::string, int> fruitless_;
  bool stopping_ = false;
  std::string trouble_;
  int trouble_code_ = base::kExitBadInput;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

void run_here(Board& board) { Local(board).run(); }

}  // namespace millscope::campaign
