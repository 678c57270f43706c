#include "kernel/output/new_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "kernel/base/error.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using base::UserError;

void refuse_folder(const fs::path& given) {
  const fs::path folder = without_end_slash(given);
  std::error_code trouble;
  if (fs::exists(fs::symlink_status(folder, trouble)))
    throw UserError(fmt::format("{} exists already; choose another name, or remove it", folder.string()));
  const fs::path parent = folder.parent_path();
  if (!parent.empty() && !fs::is_directory(parent, trouble))
    throw UserError(fmt::format("{}: there is no folder {}; make it first, or choose another place", folder.string(), parent.string()));
}

NewFolder::NewFolder(const fs::path& target) : target_(without_end_slash(target)) {
  refuse_folder(target_);
  std::error_code trouble;
  for (int n = 0;; ++n) {
    path_ = fmt::format("{}.{}.tmp", target_.string(), n);
    if (fs::create_directory(path_, trouble)) return;
    if (trouble) throw_write_error(target_, trouble.value());
  }
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!published_) fs::remove_all(path_, ignored);
}

void NewFolder::publish() {
  if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) != 0) {
    const bool taken = errno == EEXIST || errno == ENOTEMPTY;
    // File systems without the flag: the check at the beginning has to do.
    if (taken || errno != EINVAL || ::rename(path_.c_str(), target_.c_str()) != 0) {
      if (taken) refuse_folder(target_);
      throw_write_error(target_, errno);
    }
  }
  published_ = true;
}

}  // namespace millscope::output
