// Plain files with honest errors: what failed, how much disk was free, what to do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace millscope::output {

/// Exit code of the errors that throw_write_error raises: the place cannot be written or is full.
inline constexpr int kExitDisk = 4;

/// Throws base::UserError for a write that failed with `error` (an errno): disk full, not permitted, …
[[noreturn]] void throw_write_error(const std::filesystem::path& file, int error);

/// Throws the disk-full error when `bytes` and a small reserve do not fit on the disk of `file`.
void require_space(const std::filesystem::path& file, std::uint64_t bytes);

/// `path` with ".tmp" appended: for files in a directory that the program holds as its own (OutputDirectory).
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Makes an empty file beside `path` to write to: `path`.tmp, or `path`.1.tmp, … where that exists; nothing that exists is touched, and no
/// link is followed.
std::filesystem::path reserve_temporary(const std::filesystem::path& path);

/// Whether a name is one that `reserve_temporary` gives for `path`.
bool is_temporary_of(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Syncs `temporary` and renames it to `path`; throws through throw_write_error.
void publish(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Throws base::UserError when `path` exists already.
void refuse_existing(const std::filesystem::path& path);

/// "1.5 MB".
std::string size_text(std::uint64_t bytes);

/// A file descriptor that writes all or throws.
class File {
 public:
  /// `flags`: of open(2).
  File(std::filesystem::path path, int flags);
  ~File();
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;

  void write(std::string_view bytes);
  void sync();
  void truncate(std::uint64_t size);
  void close();
  int descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// A file that appears whole or not at all: written aside, synced and renamed by `commit`.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  void write_through();
  std::filesystem::path path_;
  File file_;
  std::string buffer_;
  bool committed_ = false;
};

/// Writes a whole file through AtomicFile. Without `overwrite` throws base::UserError when `path` exists already.
void write_file(const std::filesystem::path& path, std::string_view bytes, bool overwrite = true);

}  // namespace millscope::output
