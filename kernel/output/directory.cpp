#include "kernel/output/directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using base::UserError;

namespace {

constexpr const char* kLockName = ".lock";

// What a run writes, and so what --force may remove.
constexpr std::array<std::string_view, 10> kOwnNames{
    "checkpoint.h5", "checkpoint.previous.h5", "frames.h5", "tracks.h5",  "results.h5", "series.csv",
    kResolvedCase,   "summary.json",           "vtk",       kEngineFolder};

bool is_own(const fs::path& entry) {
  const fs::path name = entry.filename();
  return name == kLockName || std::any_of(kOwnNames.begin(), kOwnNames.end(),
                                          [&name](std::string_view own) { return name == own || is_temporary_of(name, own); });
}

std::vector<fs::path> entries_of(const fs::path& directory) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    if (entry.path().filename() != kLockName) entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

void check_contents(const fs::path& path, Mode mode) {
  const std::string name = path.string();
  if (mode == Mode::resume) {
    if (!fs::is_directory(path)) throw UserError(fmt::format("{}: no such directory; give the -o of the run to resume", name));
    if (!fs::is_directory(path / kEngineFolder)) newest_checkpoint(path);
    return;
  }
  if (!fs::exists(path)) return;
  if (!fs::is_directory(path)) throw UserError(fmt::format("{}: is a file, a directory is needed; choose another -o", name));
  const std::vector<fs::path> entries = entries_of(path);
  if (entries.empty()) return;
  if (mode == Mode::fresh) {
    throw UserError(
        fmt::format("{}: is not empty and is not overwritten; 'millscope resume {}' continues its run, another -o keeps it, "
                    "--force replaces it",
                    name, name));
  }
  const auto foreign = std::find_if_not(entries.begin(), entries.end(), is_own);
  if (foreign == entries.end()) return;
  throw UserError(fmt::format("{}: --force removes only what a run wrote, and {} is something else; move it away or choose another -o",
                              name, foreign->filename().string()));
}

// What a run that was killed left half written. The directory is locked and all of it the run's own.
void remove_temporaries(const fs::path& directory) {
  std::vector<fs::path> entries = entries_of(directory);
  if (const fs::path pictures = directory / "vtk"; fs::is_directory(pictures)) {
    for (fs::path& picture : entries_of(pictures)) entries.push_back(std::move(picture));
  }
  for (const fs::path& entry : entries) {
    const bool pictures = entry.parent_path() != directory;
    if (entry.extension() == ".tmp" && (pictures || is_own(entry))) fs::remove(entry);
  }
}

// Makes `path` and its missing parents; returns those that were made, outermost first.
std::vector<fs::path> make_directories(const fs::path& path) {
  std::vector<fs::path> missing;
  for (fs::path at = path; !at.empty() && !fs::exists(at); at = at.parent_path()) missing.insert(missing.begin(), at);
  std::vector<fs::path> made;
  for (const fs::path& directory : missing) {
    if (::mkdir(directory.c_str(), 0777) == 0) {
      made.push_back(directory);
    } else if (errno != EEXIST) {
      const int error = errno;
      for (; !made.empty(); made.pop_back()) ::rmdir(made.back().c_str());
      throw_write_error(directory, error);
    }
  }
  return made;
}

// Locks OUT/.lock. A lock file that its last holder removed meanwhile does not count.
File lock(const fs::path& directory) {
  const fs::path path = directory / kLockName;
  for (;;) {
    File file(path, O_RDWR | O_CREAT);
    if (::flock(file.descriptor(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) throw_write_error(path, errno);
      throw UserError(fmt::format("{}: another run is writing there; wait for it, stop it, or choose another -o", directory.string()));
    }
    struct stat held {
    }, named{};
    if (::fstat(file.descriptor(), &held) == 0 && ::stat(path.c_str(), &named) == 0 && held.st_ino == named.st_ino) return file;
  }
}

void check_space(const fs::path& path, std::uint64_t needed) {
  const std::uint64_t free = free_bytes(path);
  if (free >= needed) return;
  throw UserError(fmt::format("{}: the run will write about {} and the disk has {} free; make room, choose another -o, or write less often",
                              path.string(), size_text(needed), size_text(free)),
                  kExitDisk);
}

}  // namespace

struct OutputDirectory::Impl {
  fs::path path;
  Mode mode;
  std::vector<fs::path> made;
  std::unique_ptr<File> held;
  bool started = false;

  void let_go() {
    if (held) ::unlink((path / kLockName).c_str());
    held.reset();
    if (started) return;
    for (; !made.empty(); made.pop_back()) ::rmdir(made.back().c_str());
  }
};

fs::path without_end_slash(fs::path path) {
  while (!path.has_filename() && path.has_parent_path() && path != path.parent_path()) path = path.parent_path();
  return path;
}

std::string name_of_folder(const fs::path& folder) {
  return without_end_slash(fs::absolute(folder).lexically_normal()).filename().string();
}

OutputDirectory::OutputDirectory(fs::path given, Mode mode, std::uint64_t needed_bytes) : impl_(std::make_unique<Impl>()) {
  const fs::path path = without_end_slash(std::move(given));
  impl_->path = path;
  impl_->mode = mode;
  try {
    check_contents(path, mode);
    check_space(path, needed_bytes);
    impl_->made = make_directories(path);
    impl_->held = std::make_unique<File>(lock(path));
    check_contents(path, mode);  // again: another run may have been faster
  } catch (const fs::filesystem_error& e) {
    impl_->let_go();
    throw_write_error(path, e.code().value());
  } catch (...) {
    impl_->let_go();
    throw;
  }
}

OutputDirectory::~OutputDirectory() { impl_->let_go(); }

void OutputDirectory::start() {
  impl_->started = true;
  if (impl_->mode == Mode::resume) remove_temporaries(impl_->path);
  if (impl_->mode != Mode::overwrite) return;
  for (const fs::path& entry : entries_of(impl_->path)) fs::remove_all(entry);
}

void OutputDirectory::undo() {
  if (impl_->mode == Mode::resume) throw std::logic_error("OutputDirectory: a run that is resumed cannot be undone");
  impl_->started = false;
  std::error_code ignored;
  for (const fs::path& entry : entries_of(impl_->path)) fs::remove_all(entry, ignored);
}

const fs::path& OutputDirectory::path() const { return impl_->path; }

}  // namespace millscope::output
