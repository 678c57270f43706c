// One head per simulation: CACHE/<key>/lock names the process that works on it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "kernel/output/file.hpp"

namespace millscope::campaign {

/// Held by one head at a time, briefly: while it looks at locks or writes into entries. Waits for its turn.
class Guard {
 public:
  explicit Guard(const std::filesystem::path& cache);
  const std::filesystem::path& file() const { return file_.path(); }

 private:
  output::File file_;
};

/// Holds a lock file; removes it at the end.
class Lock {
 public:
  /// Nothing when a living head holds it. Whether a head of this machine lives is asked of the system; a head of another machine is
  /// taken for dead when it has not touched its lock for two minutes. `cache`: whose .guard orders heads that come at once.
  static std::unique_ptr<Lock> try_take(const std::filesystem::path& cache, const std::filesystem::path& file);
  ~Lock();
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  /// To be called now and then: tells other machines that this head lives.
  void keep_alive();

 private:
  Lock(std::filesystem::path file, std::string text);
  std::filesystem::path file_;
  std::string text_;
  std::chrono::steady_clock::time_point touched_;
};

}  // namespace millscope::campaign
