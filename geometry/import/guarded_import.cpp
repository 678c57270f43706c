#include "geometry/import/guarded_import.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "geometry/import/answer.hpp"
#include "geometry/import/preflight.hpp"
#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

using Clock = std::chrono::steady_clock;

std::size_t check_file(const std::string& path, const ImportLimits& limits) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) {
    throw Refusal(std::string("cannot be opened (") + std::strerror(errno) +
                  "): check the path; it counts from the folder of the YAML file");
  }
  if (!S_ISREG(info.st_mode)) throw Refusal("is not a file: name one that holds the body");
  const auto size = as_size(info.st_size);
  if (size == 0) throw Refusal("is empty: export it again");
  if (size > limits.most_bytes()) {
    throw Refusal(std::to_string(size / 1000000) + " MB is more than " + std::to_string(limits.max_triangles) +
                  " triangles (max_triangles) need: export a coarser mesh or raise max_triangles");
  }
  return size;
}

std::size_t own_address_space() {
  std::size_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * as_size(::sysconf(_SC_PAGESIZE));
}

/// The child between fork and the import: limits, no core file, no output, dies with the host.
void confine_child(std::size_t address_space, double seconds) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM, SIGXCPU, SIGPIPE})
    std::signal(number, SIG_DFL);
  const rlimit memory{address_space, address_space}, none{0, 0};
  const auto cpu = static_cast<rlim_t>(seconds) + 1;
  const rlimit time{cpu, cpu};
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_CPU, &time);
  const int null = ::open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) ::dup2(null, stream);
}

/// A child that is always killed and reaped.
class Child {
 public:
  Child(pid_t pid, int pipe) : pid_(pid), pipe_(pipe) {}
  ~Child() { finish(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int pipe() const { return pipe_; }
  /// Status of waitpid; 0 when someone else has reaped it.
  int finish() {
    if (pid_ <= 0) return status_;
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
    }
    ::close(pipe_);
    pid_ = 0;
    return status_;
  }

 private:
  pid_t pid_;
  int pipe_, status_ = 0;
};

/// Everything the child writes until it closes the pipe.
std::vector<char> read_answer(int pipe, double seconds) {
  std::vector<char> answer;
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd wanted{pipe, POLLIN, 0};
    const int ready = left > 0 ? ::poll(&wanted, 1, static_cast<int>(std::min<long long>(left, 1000))) : -1;
    if (left <= 0) {
      char text[160];
      std::snprintf(text, sizeof text, "was not read within %.0f s: it is damaged or hostile; export it again or as STL", seconds);
      throw Refusal(text);
    }
    if (ready <= 0) continue;
    const std::size_t chunk = std::size_t{1} << 16, used = answer.size();
    answer.resize(used + chunk);
    const ssize_t got = ::read(pipe, answer.data() + used, chunk);
    answer.resize(used + as_size(std::max<ssize_t>(got, 0)));
    if (got == 0) return answer;
    if (got < 0 && errno != EINTR) return answer;
  }
}

std::string how_it_died(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)  // what the system's loader ends with
    return "could not be read, because a library of its reader is missing: install millscope again, with what it depends on";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "took too much processor time to read: it is damaged or hostile; export it again";
  if (WIFSIGNALED(status) && WTERMSIG(status) != SIGKILL) {
    return std::string("made the reader crash (") + strsignal(WTERMSIG(status)) +
           "): it is damaged or hostile; export it again, as STL if that is possible";
  }
  return "made the reader stop half-way: it is damaged or hostile; export it again, as STL if that is possible";
}

/// The reader's last words are its answer; it never returns.
[[noreturn]] void be_the_child(int pipe, const ReadInChild& read) noexcept {
  try {
    read(pipe);
  } catch (const std::bad_alloc&) {
    send_refusal(pipe, "needs more memory than is allowed for a file of its size: it is damaged or hostile; export it again");
  } catch (const std::exception& e) {
    send_refusal(pipe, e.what());
  } catch (...) {
    send_refusal(pipe, "the reader failed: export it again, as STL if that is possible");
  }
  _exit(0);
}

Soup read_in_child(const ReadInChild& read, const ImportLimits& limits, std::size_t size) {
  const double seconds = limits.base_seconds + limits.seconds_per_megabyte * static_cast<double>(size) / 1e6;
  const std::size_t extra = std::min(limits.bytes_per_byte * size, limits.bytes_per_triangle * limits.max_triangles);
  const std::size_t address_space = own_address_space() + limits.base_bytes + extra;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Refusal(std::string("no pipe to the reader (") + std::strerror(errno) + "): close other programs");
  const pid_t pid = ::fork();
  if (pid < 0) {
    const int why = errno;
    ::close(ends[0]), ::close(ends[1]);
    throw Refusal(std::string("no process for the reader (") + std::strerror(why) + "): close other programs");
  }
  if (pid == 0) {
    confine_child(address_space, seconds);
    be_the_child(ends[1], read);
  }
  ::close(ends[1]);
  Child child(pid, ends[0]);
  const std::vector<char> answer = read_answer(child.pipe(), seconds);
  Soup soup;
  if (!parse_answer(answer, soup)) throw Refusal(how_it_died(child.finish()));
  return soup;
}

}  // namespace

std::string lower_extension(const std::string& path) {
  const std::size_t slash = path.find_last_of('/'), dot = path.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
  return detail::lower(path.substr(dot + 1));
}

Soup read_guarded(const std::string& path, const ImportLimits& limits, const ReadInChild& read) {
  Soup soup = read_in_child(read, limits, check_file(path, limits));
  if (soup.size() == 0) throw Refusal("holds no triangles: export the body as a mesh, not as points or lines");
  return soup;
}

}  // namespace millscope::geometry
