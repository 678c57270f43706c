// What is said when a file cannot be written.
#include <fmt/format.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>

#include "kernel/base/error.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using base::UserError;

namespace {

// Left free by require_space: room for the metadata that HDF5 writes when it closes a file.
constexpr std::uint64_t kReserve = 256 * 1024;

// What to do once there is room: resume the run that the file belongs to, if it has a checkpoint.
std::string remedy_when_full(const fs::path& file) {
  for (const fs::path& directory : {file.parent_path(), file.parent_path().parent_path()}) {
    std::error_code ignored;
    if (fs::exists(checkpoint_path(directory), ignored)) {
      return fmt::format("the last checkpoint is intact: make room, then 'millscope resume {}'", directory.string());
    }
  }
  return "make room or choose another place with -o, then start again";
}

}  // namespace

std::string size_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fmt::format("{:.{}f} {}", value, unit == 0 ? 0 : 1, kUnits[unit]);
}

std::uint64_t free_bytes(const fs::path& path) {
  fs::path place = fs::absolute(path);
  struct statvfs disk {};
  while (::statvfs(place.c_str(), &disk) != 0) {
    if (place == place.parent_path()) return 0;
    place = place.parent_path();
  }
  if (disk.f_blocks == 0) return std::numeric_limits<std::uint64_t>::max();  // no disk (/proc): what is wrong there is found on writing
  return static_cast<std::uint64_t>(disk.f_bavail) * disk.f_frsize;
}

void throw_write_error(const fs::path& file, int error) {
  const std::string name = file.string();
  if (error == ENOSPC || error == EDQUOT) {
    throw UserError(fmt::format("{}: the {} is full ({} free); {}", name, error == EDQUOT ? "disk quota" : "disk",
                                size_text(free_bytes(file)), remedy_when_full(file)),
                    kExitDisk);
  }
  if (error == EFBIG) {
    throw UserError(fmt::format("{}: the file would be larger than this system allows (see 'ulimit -f'); {}", name, remedy_when_full(file)),
                    kExitDisk);
  }
  throw UserError(fmt::format("{}: cannot be written ({}); choose a place where you may write, with -o", name, std::strerror(error)),
                  kExitDisk);
}

void require_space(const fs::path& file, std::uint64_t bytes) {
  if (free_bytes(file) < bytes + kReserve) throw_write_error(file, ENOSPC);
}

void refuse_existing(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  throw UserError(fmt::format("{}: exists already and is not overwritten; choose another -o, or use --force", path.string()));
}

}  // namespace millscope::output
