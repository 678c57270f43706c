#include "studies/campaign/lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "kernel/base/text.hpp"
#include "kernel/output/file.hpp"
#include "studies/campaign/cache.hpp"

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kTouchEvery = 20;  // s
constexpr double kDeadAfter = 120;  // s without a touch, on another machine

/// Start time of a process in clock ticks since boot: tells a process from a later one of the same number. "" when there is none.
std::string birth_of(long pid) {
  const std::optional<std::string> text = base::text_if_readable(fmt::format("/proc/{}/stat", pid));
  if (!text) return "";
  std::istringstream rest(text->substr(text->rfind(')') + 1));  // the name may hold anything
  std::string word;
  for (int field = 3; field <= 22 && rest >> word; ++field) {
    if (field == 3 && (word == "Z" || word == "X")) return "";  // dead, not yet reaped
  }
  return word;
}

double modified(const fs::path& file) {
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0) return 0;
  return static_cast<double>(s.st_mtim.tv_sec) + 1e-9 * static_cast<double>(s.st_mtim.tv_nsec);
}

/// `guard` has just been touched: both times are of the disk's own clock.
bool is_stale(const fs::path& file, const std::string& text, const fs::path& guard) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_object() && json.value("host", "") == host_name()) return birth_of(json.value("process", 0L)) != json.value("birth", "");
  return modified(guard) - modified(file) > kDeadAfter;
}

std::string own_text() {
  const long pid = ::getpid();
  return nlohmann::json{{"host", host_name()}, {"process", pid}, {"birth", birth_of(pid)}}.dump() + "\n";
}

}  // namespace

Guard::Guard(const fs::path& cache) : file_(cache / ".guard", O_RDWR | O_CREAT) {
  while (::flock(file_.descriptor(), LOCK_EX) != 0) {
    if (errno != EINTR) output::throw_write_error(file_.path(), errno);
  }
  ::futimens(file_.descriptor(), nullptr);
}

std::unique_ptr<Lock> Lock::try_take(const fs::path& cache, const fs::path& file) {
  const Guard guard(cache);
  if (const std::optional<std::string> text = base::text_if_readable(file)) {
    if (!is_stale(file, *text, guard.file())) return nullptr;
  }
  const std::string text = own_text();
  output::write_file(file, text);
  return std::unique_ptr<Lock>(new Lock(file, text));
}

Lock::Lock(fs::path file, std::string text) : file_(std::move(file)), text_(std::move(text)), touched_(Clock::now()) {}

// A head that was stopped for minutes may have lost its lock: it removes only its own.
Lock::~Lock() {
  if (base::text_if_readable(file_) == text_) ::unlink(file_.c_str());
}

void Lock::keep_alive() {
  if (std::chrono::duration<double>(Clock::now() - touched_).count() < kTouchEvery) return;
  ::utimensat(AT_FDCWD, file_.c_str(), nullptr, 0);
  touched_ = Clock::now();
}

}  // namespace millscope::campaign
