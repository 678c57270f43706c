// The simulations of a campaign as tasks of Slurm. Who reads what: entry/job.json says as which task a simulation was handed over, so
// that a head that comes back finds it; the tasks write task.json and run/ themselves.
#include <fmt/format.h>

#include <unistd.h>
#include <algorithm>
#include <ctime>
#include <list>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "kernel/output/summary.hpp"
#include "studies/campaign/board.hpp"
#include "studies/campaign/signals.hpp"
#include "studies/campaign/slurm_queue.hpp"

namespace millscope::campaign {
namespace {

using Clock = std::chrono::steady_clock;
using base::UserError;

constexpr std::size_t kLargestArray = 1000;            // below Slurm's default MaxArraySize
constexpr int kTries = 3;                              // lost tasks without a newer checkpoint
constexpr int kMissingLooks = 2;                       // a shared directory may show results later than the queue shows the end
constexpr double kQueuePatience = 300;                 // s that squeue may fail: controllers are restarted now and then
constexpr std::uint64_t kUsualMemory = 1'000'000'000;  // bytes: what any partition gives a task; more is asked for
constexpr auto kQueueBreath = std::chrono::milliseconds(50);

struct Handed {
  Job job;
  std::unique_ptr<Lock> lock;
  std::string batch{};  ///< name; "": to be handed over
  int index = 0;
  int tries = 1;
  std::int64_t checkpoint = 0;  ///< when it was handed over
  int missing = 0;              ///< looks at the queue that did not find it

  std::filesystem::path note() const { return job.entry.folder() / "job.json"; }
  std::string task() const { return fmt::format("millscope-{} {}", batch, index); }
};

class Slurm {
 public:
  explicit Slurm(Board& board) : board_(board) { require_slurm(); }

  void run() {
    while (!board_.open().empty() || !handed_.empty()) {
      if (signals_.arrived()) interrupt();
      take_over();
      if (now() >= next_poll_) {
        hand_over();
        look();
        next_poll_ = now() + board_.options().poll_s;
      }
      report();
      std::this_thread::sleep_for(kQueueBreath);
    }
  }

 private:
  /// The tasks go on without a head.
  [[noreturn]] void interrupt() {
    std::vector<std::string> names;
    for (const Handed& h : handed_) {
      const std::string name = "millscope-" + h.batch;
      if (!h.batch.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    throw Interrupted(board_.interrupted_message(
        names.empty() ? "nothing is left in Slurm"
                      : fmt::format("the tasks stay in Slurm and go on (scancel --name={} ends them)", fmt::join(names, ","))));
  }

  void take_over() {
    std::deque<Job>& open = board_.open();
    for (auto job = open.begin(); job != open.end();) {
      if (job->next_look > now() || !board_.donor_of(*job)) {
        ++job;
        continue;
      }
      std::unique_ptr<Lock> lock = take(*job, board_);
      const std::optional<TaskRecord> record = board_.settled(*job);
      if (!lock && !record) {
        job->next_look = now() + board_.options().poll_s;
        ++job;
        continue;
      }
      if (record) {
        finish(*job, *record, true);
      } else {
        handed_.push_back(recall({*job, std::move(lock)}));
      }
      job = open.erase(job);
    }
  }

  void finish(const Job& job, const TaskRecord& record, bool cached) {
    std::filesystem::remove(job.entry.folder() / "job.json");
    board_.finish(job, record, cached);
  }

  /// What an earlier head has handed over already.
  static Handed recall(Handed h) {
    const nlohmann::ordered_json json = output::read_json(h.note());
    if (!json.is_object() || h.job.afresh) return h;
    h.batch = json.value("batch", "");
    h.index = json.value("index", 0);
    h.tries = json.value("tries", 1);
    h.checkpoint = json.value("checkpoint", std::int64_t{0});
    return h;
  }

  void hand_over() {
    std::map<int, std::vector<Handed*>> fresh;  // by cores: those of an array have as many each
    for (Handed& h : handed_) {
      if (h.batch.empty()) fresh[h.job.cores].push_back(&h);
    }
    for (const auto& [cores, all] : fresh) {
      for (std::size_t from = 0; from < all.size(); from += kLargestArray) {
        const std::size_t count = std::min(kLargestArray, all.size() - from);
        hand_over({all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(from + count)});
      }
    }
  }

  void hand_over(const std::vector<Handed*>& tasks) {
    const Options& options = board_.options();
    const std::string name = fmt::format("{}-{}-{}-{}", std::time(nullptr), host_name(), ::getpid(), ++batches_);
    Batch batch{options.cache / "slurm" / name, {}, command(), tasks[0]->job.cores, {}};
    std::uint64_t memory = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      Handed& h = *tasks[i];
      h.batch = name;
      h.index = static_cast<int>(i);
      h.checkpoint = h.job.entry.checkpoint_time();
      h.missing = 0;
      memory = std::max(memory, h.job.memory);
      batch.entries.push_back(h.job.entry.folder());
      output::write_json(h.note(), {{"batch", name}, {"index", h.index}, {"tries", h.tries}, {"checkpoint", h.checkpoint}});
    }
    batch.sbatch_options = {fmt::format("--array=0-{}{}", tasks.size() - 1,
                                        options.slots > 0 ? fmt::format("%{}", std::max(1, options.slots / batch.cores)) : "")};
    if (memory > kUsualMemory) batch.sbatch_options.push_back(fmt::format("--mem={}M", memory / 1'000'000 + 1));
    batch.sbatch_options.insert(batch.sbatch_options.end(), options.slurm_options.begin(), options.slurm_options.end());
    const std::string refusal = submit(batch);
    if (refusal.empty()) return;
    for (Handed* h : tasks) {
      std::filesystem::remove(h->note());
      h->batch.clear();
    }
    const bool others_are_under_way = std::any_of(handed_.begin(), handed_.end(), [](const Handed& h) { return !h.batch.empty(); });
    if (!others_are_under_way) throw UserError(fmt::format("runner slurm: sbatch refuses the campaign: {}", refusal));
  }

  std::vector<std::string> command() const {
    const Options& options = board_.options();
    const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe");
    std::vector<std::string> words{options.program.empty() ? own.string() : std::filesystem::absolute(options.program).string(),
                                   "campaign-task"};
    for (const std::filesystem::path& directory : options.plugin_directories)
      words.insert(words.end(), {"--plugin-dir", directory.string()});
    return words;
  }

  void look() {
    std::string trouble;
    const auto tasks = queue(trouble);
    if (!tasks) {
      if (!trouble_since_) trouble_since_ = now();
      if (now() - *trouble_since_ > kQueuePatience)
        throw UserError(fmt::format("runner slurm: squeue fails: {}; the tasks go on, and the same command finds them again", trouble));
      return;
    }
    trouble_since_.reset();
    running_ = 0;
    for (auto h = handed_.begin(); h != handed_.end();) {
      h->lock->keep_alive();
      const auto found = tasks->find(h->task());
      h->missing = found == tasks->end() ? h->missing + 1 : 0;
      if (found != tasks->end() && found->second == "RUNNING") ++running_;
      h = !h->batch.empty() && has_ended(*h) ? handed_.erase(h) : std::next(h);
    }
  }

  /// A task that is neither in the queue nor finished is lost: it was killed, or its machine was.
  bool has_ended(Handed& h) {
    if (const std::optional<TaskRecord> record = board_.settled(h.job)) {
      finish(h.job, *record, false);
      return true;
    }
    if (h.missing < kMissingLooks) return false;
    h.tries = h.job.entry.checkpoint_time() != h.checkpoint ? 1 : h.tries + 1;
    if (h.tries > kTries) {
      const std::string said = last_line(board_.options().cache / "slurm" / h.batch / fmt::format("task_{}.log", h.index));
      std::filesystem::remove(h.note());
      board_.fail(h.job, fmt::format("lost {} times in Slurm before a checkpoint{}", kTries,
                                     said.empty() ? "" : "; last words of the task: " + said));
      return true;
    }
    h.batch.clear();  // is handed over again
    return false;
  }

  void report() {
    if (!board_.progress().due()) return;
    std::vector<Underway> underway(running_);
    double waiting = 0;
    for (const Handed& h : handed_) waiting += h.job.work;
    for (const Job& job : board_.open()) waiting += job.work;
    board_.progress().update(underway, waiting, std::max(1, running_));
  }

  double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Board& board_;
  StopSignals signals_;
  std::list<Handed> handed_;
  std::optional<double> trouble_since_;
  double next_poll_ = 0;
  int running_ = 0, batches_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

void run_on_slurm(Board& board) { Slurm(board).run(); }

}  // namespace millscope::campaign
