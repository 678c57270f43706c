#include "kernel/host/directory_check.hpp"

#include <fmt/core.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <vector>

#include "kernel/base/error.hpp"

namespace millscope::host {

namespace {

struct stat status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw base::UserError(fmt::format("plugin path '{}': {}", path, std::strerror(errno)));
  }
  return status;
}

/// The user's own group, of the user's name and without other members, as Debian makes one for each user: with it a umask of 002 is usual.
bool is_private_group(gid_t group) {
  struct passwd user {};
  struct group own {};
  struct passwd* found_user = nullptr;
  struct group* found_group = nullptr;
  std::vector<char> user_text(16384), group_text(1 << 20);
  if (::getpwuid_r(::geteuid(), &user, user_text.data(), user_text.size(), &found_user) != 0 || found_user == nullptr) return false;
  if (user.pw_gid != group) return false;
  if (::getgrgid_r(group, &own, group_text.data(), group_text.size(), &found_group) != 0 || found_group == nullptr) return false;
  const std::string_view name = user.pw_name;
  if (own.gr_name != name) return false;
  for (char** member = own.gr_mem; *member != nullptr; ++member) {
    if (*member != name) return false;
  }
  return true;
}

bool foreign_owner(const struct stat& status) { return status.st_uid != 0 && status.st_uid != ::geteuid(); }

/// Who else can change what lies at a path, or "".
std::string other_writers(const struct stat& status) {
  if ((status.st_mode & S_IWOTH) != 0) return "anyone";
  return (status.st_mode & S_IWGRP) != 0 && !is_private_group(status.st_gid) ? "its group" : "";
}

/// Where the administrator says by a group who may install: Debian makes /usr/local writable for `staff`.
bool is_system_directory(const std::filesystem::path& path, const struct stat& status) {
  const auto first = std::next(path.begin());
  return status.st_uid == 0 && first != path.end() && (*first == "usr" || *first == "opt");
}

/// Who can write to a directory can put another one in the place of what lies in it, unless the directory is sticky.
void check_parents(const std::filesystem::path& path) {
  for (std::filesystem::path above = path.parent_path(); above.has_relative_path(); above = above.parent_path()) {
    const struct stat status = status_of(above.string());
    if (foreign_owner(status)) {
      throw base::UserError(
          fmt::format("plugins are not loaded from '{}': '{}' above it belongs to user id {}, neither to you nor to root; copy the plugins "
                      "to a directory of your own, or chown it",
                      path.string(), above.string(), status.st_uid));
    }
    const std::string writers = other_writers(status);
    if (writers.empty() || (status.st_mode & S_ISVTX) != 0) continue;
    if (writers != "anyone" && is_system_directory(above, status)) continue;
    throw base::UserError(fmt::format("plugins are not loaded from '{}': {} can write to '{}' above it; chmod {}-w '{}'", path.string(),
                                      writers, above.string(), writers == "anyone" ? "go" : "g", above.string()));
  }
}

}  // namespace

void require_private(const std::string& path) {
  const struct stat status = status_of(path);
  if (foreign_owner(status)) {
    throw base::UserError(
        fmt::format("plugins are not loaded from '{}': it belongs to user id {}, neither to you nor to root; copy it or chown it", path,
                    status.st_uid));
  }
  const std::string writers = other_writers(status);
  if (!writers.empty())
    throw base::UserError(fmt::format("plugins are not loaded from '{}': {} can write to it; chmod go-w '{}'", path, writers, path));
  check_parents(path);
}

}  // namespace millscope::host
