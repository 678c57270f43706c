#include "studies/new/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "kernel/config/document.hpp"
#include "kernel/output/file.hpp"
#include "kernel/run/assembly.hpp"
#include "kernel/run/simulation.hpp"

namespace millscope::new_mill {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr std::uint64_t kQuickBeads = 200000;  // more take long to place, and are placed by 'millscope check'

/// A folder beside `target` that is removed unless it was published.
class Aside {
 public:
  explicit Aside(const fs::path& target) : target_(target) {
    std::error_code trouble;
    for (int n = 0;; ++n) {
      path_ = fmt::format("{}.{}.tmp", target.string(), n);
      if (fs::create_directory(path_, trouble)) return;
      if (trouble) output::throw_write_error(target, trouble.value());
    }
  }
  ~Aside() {
    std::error_code ignored;
    if (!published_) fs::remove_all(path_, ignored);
  }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;

  const fs::path& path() const { return path_; }
  void publish() {
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) != 0) {
      const bool taken = errno == EEXIST || errno == ENOTEMPTY;
      // File systems without the flag: the check at the beginning has to do.
      if (taken || errno != EINVAL || ::rename(path_.c_str(), target_.c_str()) != 0) {
        if (taken) refuse_folder(target_);
        output::throw_write_error(target_, errno);
      }
    }
    published_ = true;
  }

 private:
  fs::path target_, path_;
  bool published_ = false;
};

void copy_into(const fs::path& from, const fs::path& to) {
  std::error_code trouble;
  fs::copy_file(from, to, trouble);
  if (trouble)
    throw UserError(
        fmt::format("{} cannot be copied: {}; check its permissions and the room on the disk", from.string(), trouble.message()));
}

Found look_at(const fs::path& case_file, const Choices& choices, const host::Registry& registry) {
  Found found;
  run::RunOptions options;
  options.quiet = true;
  if (choices.beads <= kQuickBeads) {
    const run::Estimate e = run::estimate(case_file.string(), registry, options);
    return {e.beads, static_cast<std::uint64_t>(e.steps), e.time_step, e.wall_seconds};
  }
  const run::Assembly a = run::assemble(config::read_case(case_file.string()), registry);
  return {a.bead_count, static_cast<std::uint64_t>(a.end_step - a.first_step), a.time_step, 0};
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

}  // namespace

std::string liner_name(const Liner& liner) {
  const std::string own = liner.file.filename().string();
  const bool plain =
      own[0] != '.' && std::all_of(own.begin(), own.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
      });
  return plain ? own : "liner" + liner.file.extension().string();
}

void refuse_folder(const fs::path& folder) {
  std::error_code trouble;
  if (fs::exists(fs::symlink_status(folder, trouble)))
    throw UserError(fmt::format("{} exists already; choose another name, or remove it", folder.string()));
  const fs::path parent = folder.parent_path();
  if (!parent.empty() && !fs::is_directory(parent, trouble))
    throw UserError(fmt::format("{}: there is no folder {}; make it first, or choose another place", folder.string(), parent.string()));
}

Found write_folder(const fs::path& folder, const Mill& mill, const Choices& choices, const host::Registry& registry) {
  refuse_folder(folder);
  Aside aside(folder);
  const std::string title = folder.filename().string();
  fs::create_directory(aside.path() / "materials");
  for (const Material* m : {&mill.bead_material, &mill.liner_material}) {
    const fs::path to = aside.path() / "materials" / (m->name + ".yaml");
    if (!fs::exists(to)) copy_into(m->file, to);
  }
  if (mill.liner) copy_into(mill.liner->file, aside.path() / liner_name(*mill.liner));
  output::write_file(aside.path() / "case.yaml", case_text(mill, choices, title));
  output::write_file(aside.path() / "README.md", readme_text(mill, choices, title));
  Found found;
  try {
    found = look_at(aside.path() / "case.yaml", choices, registry);
  } catch (const UserError& e) {
    throw UserError("nothing was written, because the case would not run: " + replaced(e.what(), aside.path().string(), folder.string()),
                    e.exit_code());
  }
  aside.publish();
  return found;
}

}  // namespace millscope::new_mill
