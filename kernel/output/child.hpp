// Other programs: one that runs beside this one, one that is asked and answers.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace millscope::output {

inline constexpr int kCannotStart = 127;  ///< exit code where the program cannot be started, as of a shell

/// How a process ended.
struct Ended {
  int exit_code = 0;  ///< meaningless when a signal ended it
  int signal = 0;     ///< 0: it ended by itself
};

/// A program that ended by itself.
struct Answer {
  int code = 0;      ///< kCannotStart: it was not started, and the text is the reason
  std::string text;  ///< what it printed, errors among it, in one line
};

/// Runs a program, found as a shell finds it, to its end.
Answer ask(const std::vector<std::string>& words);

/// A process in a group of its own, so that a terminal's Ctrl-C reaches only its head; it gets SIGTERM when its head dies. Its output goes
/// to a file.
class Child {
 public:
  /// `directory`: where it works; empty: where this program does. Throws UserError when no process can be started.
  Child(const std::vector<std::string>& command, const std::filesystem::path& messages, const std::filesystem::path& directory = {});
  /// Asks it to stop and waits, when it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Nothing while it runs.
  std::optional<Ended> poll();
  /// SIGTERM, once: a second one would kill it before its checkpoint is written.
  void ask_to_stop();
  double elapsed() const;          ///< s
  std::uint64_t resident() const;  ///< bytes of memory that it holds now
  pid_t process() const { return process_; }

 private:
  pid_t process_ = -1;
  bool asked_ = false;
  std::optional<Ended> ended_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// The program that runs now, as a path that can be started.
std::string own_program();

}  // namespace millscope::output
