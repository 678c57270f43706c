#include "studies/campaign/task.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <csignal>
#include <new>
#include <thread>

#include "kernel/output/archive.hpp"
#include "kernel/output/file.hpp"
#include "kernel/run/simulation.hpp"
#include "studies/campaign/cache.hpp"
#include "studies/engine/engine.hpp"

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr double kPatience = 30;  // s for another process to write its last checkpoint

void on_signal(int signal) {
  run::request_stop();
  std::signal(signal, SIG_DFL);
}

/// A run holds this lock as long as it lives (kernel/output/directory.hpp).
bool is_busy(const fs::path& run) {
  const int descriptor = ::open((run / ".lock").c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool busy = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0;
  ::close(descriptor);
  return busy;
}

bool becomes_free(const fs::path& run) {
  for (double waited = 0; is_busy(run); waited += 0.05) {
    if (waited > kPatience) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

bool is_sound(const fs::path& checkpoint) {
  try {
    const output::ArchiveReader archive(checkpoint);
    return true;
  } catch (const UserError&) {
    return false;
  }
}

bool has_checkpoint(const fs::path& run) {
  return is_sound(output::checkpoint_path(run)) || is_sound(output::previous_checkpoint_path(run));
}

run::Outcome simulate(const Entry& entry, const host::Registry& registry) {
  run::RunOptions options;
  options.output = entry.run();
  options.threads = 1;
  options.quiet = true;
  options.force = true;  // what a run left that was killed before its first checkpoint
  if (engine::is_run(entry.run()) || has_checkpoint(entry.run())) {
    options.command_line = {"millscope", "resume", entry.run().string(), "--threads", "1"};
    return engine::resume_run(registry, options);
  }
  options.command_line = {"millscope", "run", entry.case_file().string(), "-o", entry.run().string(), "--threads", "1"};
  return engine::run_case(entry.case_file().string(), registry, options);
}

int failed(const Entry& entry, TaskRecord record, const std::string& message) {
  record.stage = Stage::failed;
  record.message = message;
  entry.write(record);
  fmt::print(stderr, "millscope: {}\n", message);
  return base::kExitBadInput;
}

}  // namespace

int perform(const fs::path& entry_folder, const host::RegistryOptions& plugins) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const Entry entry(entry_folder);
  if (!fs::exists(entry.case_file())) throw UserError(entry.folder().string() + ": is no simulation of a campaign (it has no case.yaml)");
  if (!becomes_free(entry.run())) return kBusy;
  TaskRecord record = entry.read();
  if (record.stage == Stage::done) return 0;
  record.stage = Stage::running;
  record.message.clear();
  record.host = host_name();
  ++record.attempts;
  entry.write(record);
  try {
    const bool finished = simulate(entry, host::Registry(plugins)) == run::Outcome::finished;
    if (finished) record = entry.read();
    record.stage = finished ? Stage::done : Stage::interrupted;
    entry.write(record);
    return finished ? 0 : kInterruptedCode;
  } catch (const UserError& e) {
    if (e.exit_code() == output::kExitDisk) throw;
    return failed(entry, record, e.what());
  } catch (const std::bad_alloc&) {
    return failed(entry, record, "out of memory; give fewer --slots");
  }
}

}  // namespace millscope::campaign
