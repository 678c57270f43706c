#include "kernel/output/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"

extern char** environ;

namespace millscope::output {
namespace {

/// Between fork and exec: only calls that are safe there. The two signals are blocked until they mean what they should.
[[noreturn]] void become(char* const* words, int output, pid_t head, const char* directory, const sigset_t* signals) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != head) ::_exit(kCannotStart);  // the head died before the line above
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, signals, nullptr);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  if (*directory == '\0' || ::chdir(directory) == 0) ::execvp(words[0], words);
  constexpr char kMessage[] = "the program cannot be started\n";
  const ssize_t ignored = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  static_cast<void>(ignored);
  ::_exit(kCannotStart);
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t n = ::read(descriptor, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(part.data(), n);
  }
}

/// Messages of this program are one line.
std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::string line;
  for (const char c : text) line += c == '\n' ? std::string("; ") : std::string(1, c);
  return line;
}

}  // namespace

Answer ask(const std::vector<std::string>& words) {
  std::vector<std::string> copy = words;
  std::vector<char*> arguments;
  for (std::string& word : copy) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw base::UserError(fmt::format("{}: no pipe can be opened: {}", words[0], std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  posix_spawnattr_t attributes;  // a group of its own: Ctrl-C is for this program
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int trouble = ::posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(pipe[1]);
  Answer answer;
  if (trouble == 0) answer.text = one_line(read_all(pipe[0]));
  ::close(pipe[0]);
  if (trouble != 0) return {kCannotStart, std::strerror(trouble)};
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  return answer;
}

Child::Child(const std::vector<std::string>& command, const std::filesystem::path& messages, const std::filesystem::path& directory) {
  output::File output(messages, O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<std::string> copy = command;
  std::vector<char*> words;
  for (std::string& word : copy) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t head = ::getpid();
  // A stop that comes before exec must not be taken by this program's handler in the copy, and so be lost.
  sigset_t stops, before;
  ::sigemptyset(&stops);
  ::sigaddset(&stops, SIGINT);
  ::sigaddset(&stops, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &stops, &before);
  process_ = ::fork();
  if (process_ == 0) become(words.data(), output.descriptor(), head, directory.c_str(), &before);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
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

}  // namespace millscope::output
