#include "studies/campaign/memory.hpp"

#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <thread>

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The number after `name` in a file of lines "name number"; with an empty name the file's first number. "max" is none.
std::optional<std::uint64_t> number_in(const fs::path& file, const std::string& name) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  if (name.empty()) return in >> number ? std::optional(number) : std::nullopt;
  for (std::string word; in >> word;) {
    if (word == name && in >> number) return number;
  }
  return {};
}

/// What one control group leaves: its limit less what it holds, where cached files do not count.
std::uint64_t left_in_group(const fs::path& group) {
  std::optional<std::uint64_t> limit = number_in(group / "memory.max", ""), used = number_in(group / "memory.current", "");
  std::optional<std::uint64_t> cached = number_in(group / "memory.stat", "inactive_file");
  if (!limit) {
    limit = number_in(group / "memory.limit_in_bytes", "");
    used = number_in(group / "memory.usage_in_bytes", "");
    cached = number_in(group / "memory.stat", "total_inactive_file");
  }
  if (!limit || !used) return kNoLimit;
  const std::uint64_t held = *used - std::min(*used, cached.value_or(0));
  return *limit - std::min(*limit, held);
}

/// Over this process's control group and those above it.
std::uint64_t left_in_groups() {
  std::uint64_t left = kNoLimit;
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && controllers != "memory") continue;
    const fs::path root = controllers.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    fs::path group = fs::path(line.substr(second + 1)).relative_path();
    for (; !group.empty(); group = group.parent_path()) left = std::min(left, left_in_group(root / group));
    left = std::min(left, left_in_group(root));
  }
  return left;
}

}  // namespace

std::uint64_t available_memory() {
  const std::optional<std::uint64_t> kilobytes = number_in("/proc/meminfo", "MemAvailable:");
  return std::min(kilobytes ? *kilobytes * 1024 : kNoLimit, left_in_groups());
}

int available_cores() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace millscope::campaign
