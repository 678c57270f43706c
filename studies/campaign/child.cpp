#include "studies/campaign/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"

namespace millscope::campaign {
namespace {

/// Between fork and exec: only calls that are safe there.
[[noreturn]] void become(char* const* words, int output, pid_t head) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != head) ::_exit(kCannotStart);  // the head died before the line above
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execv(words[0], words);
  constexpr char kMessage[] = "the program cannot be started\n";
  const ssize_t ignored = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  static_cast<void>(ignored);
  ::_exit(kCannotStart);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::filesystem::path& messages) {
  output::File output(messages, O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<std::string> copy = command;
  std::vector<char*> words;
  for (std::string& word : copy) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t head = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(words.data(), output.descriptor(), head);
  if (process_ < 0) {
    throw base::UserError(fmt::format("no process can be started for a simulation ({}); give fewer --slots or raise the limit (ulimit -u)",
                                      std::strerror(errno)));
  }
}

Child::~Child() {
  if (ended_) return;
  ask_to_stop();
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::optional<Ended> Child::poll() {
  if (ended_) return ended_;
  int status = 0;
  const pid_t found = ::waitpid(process_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR)) return {};
  ended_ = found < 0 ? Ended{1, 0} : Ended{WIFEXITED(status) ? WEXITSTATUS(status) : 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
  return ended_;
}

void Child::ask_to_stop() {
  if (!asked_ && !ended_) ::kill(process_, SIGTERM);
  asked_ = true;
}

double Child::elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count(); }

std::uint64_t Child::resident() const {
  std::ifstream in(fmt::format("/proc/{}/statm", process_));
  std::uint64_t total = 0, pages = 0;
  return in >> total >> pages ? pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

// The link serves even when the file behind it has been replaced by a newer build.
std::string own_program() { return "/proc/self/exe"; }

}  // namespace millscope::campaign
