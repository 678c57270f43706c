#include "kernel/host/directory_check.hpp"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "kernel/config/error.hpp"

namespace millscope::host {

namespace {

struct stat status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw config::UserError(fmt::format("plugin path '{}': {}", path, std::strerror(errno)));
  }
  return status;
}

void check_parents(const std::filesystem::path& path) {
  for (std::filesystem::path above = path.parent_path(); above.has_relative_path(); above = above.parent_path()) {
    const struct stat status = status_of(above.string());
    if ((status.st_mode & S_IWOTH) != 0 && (status.st_mode & S_ISVTX) == 0) {
      throw config::UserError(fmt::format("plugins are not loaded from '{}': anyone can write to '{}' above it; chmod o-w '{}'",
                                          path.string(), above.string(), above.string()));
    }
  }
}

}  // namespace

void require_private(const std::string& path) {
  const struct stat status = status_of(path);
  if (status.st_uid != 0 && status.st_uid != ::geteuid()) {
    throw config::UserError(
        fmt::format("plugins are not loaded from '{}': it belongs to user id {}, neither to you nor to root; copy it or chown it", path,
                    status.st_uid));
  }
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    throw config::UserError(fmt::format("plugins are not loaded from '{}': {} can write to it; chmod go-w '{}'", path,
                                        (status.st_mode & S_IWOTH) != 0 ? "anyone" : "its group", path));
  }
  check_parents(path);
}

}  // namespace millscope::host
