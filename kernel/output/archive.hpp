// Archives: named arrays, exact to the bit, whole or not at all. Checkpoints are archives.
//
// An archive is an HDF5 file (one contiguous dataset per array) followed by a seal of 32 bytes: magic, length and checksum of every
// byte before it. The reader checks the seal before HDF5 sees the file, so that no damaged byte gets any further.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace millscope::output {

/// The types that an archive holds.
template <class T>
concept ArchiveValue = std::same_as<T, double> || std::same_as<T, std::int32_t> || std::same_as<T, std::int64_t> ||
    std::same_as<T, std::uint8_t> || std::same_as<T, std::uint32_t> || std::same_as<T, std::uint64_t>;

/// Raised when an archive's layout changes; a reader refuses any other number.
inline constexpr std::uint32_t kArchiveSchema = 1;

/// Writes `path`.tmp and renames it to `path` in `commit`. Without `commit`, or after a failure, `path` is as it was before.
/// Every member throws base::UserError when the disk is full or the file cannot be written.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(std::filesystem::path path);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Stores values[n] under `name`; "contacts/history" lies in the group "contacts". Each name once.
  void write(const std::string& name, std::span<const double> values);
  void write(const std::string& name, std::span<const std::int32_t> values);
  void write(const std::string& name, std::span<const std::int64_t> values);
  void write(const std::string& name, std::span<const std::uint8_t> values);
  void write(const std::string& name, std::span<const std::uint32_t> values);
  void write(const std::string& name, std::span<const std::uint64_t> values);
  template <ArchiveValue T>
  void write(const std::string& name, const std::vector<T>& values) {
    write(name, std::span<const T>(values));
  }
  template <ArchiveValue T>
  void write_value(const std::string& name, T value) {
    write(name, std::span<const T>(&value, 1));
  }
  void write_text(const std::string& name, const std::string& text);

  /// Completes `path`.tmp: all that can fail for want of room. Nothing can be written afterwards. Called by `commit` where it was not
  /// before; a checkpoint is sealed, then rotate_checkpoints, then committed.
  void seal();
  /// Seals, syncs and renames. At most once.
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Opens an archive and checks every byte of it. Throws base::UserError when it is missing, cut short, damaged or of another
/// schema version; asking for a name that is not there, or as another type, is a UserError too (an archive of another program).
class ArchiveReader {
 public:
  explicit ArchiveReader(std::filesystem::path path);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  const std::filesystem::path& path() const;
  bool has(const std::string& name) const;
  std::size_t size(const std::string& name) const;

  /// The whole array `name`.
  template <ArchiveValue T>
  std::vector<T> read(const std::string& name) const {
    std::vector<T> values(size(name));
    read_into(name, std::span<T>(values));
    return values;
  }
  /// The single value `name`.
  template <ArchiveValue T>
  T read_value(const std::string& name) const {
    T value{};
    read_into(name, std::span<T>(&value, 1));
    return value;
  }
  /// Fills `values`, whose length must be that of the array.
  void read_into(const std::string& name, std::span<double> values) const;
  void read_into(const std::string& name, std::span<std::int32_t> values) const;
  void read_into(const std::string& name, std::span<std::int64_t> values) const;
  void read_into(const std::string& name, std::span<std::uint8_t> values) const;
  void read_into(const std::string& name, std::span<std::uint32_t> values) const;
  void read_into(const std::string& name, std::span<std::uint64_t> values) const;
  std::string read_text(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// OUT/checkpoint.h5 and OUT/checkpoint.previous.h5.
std::filesystem::path checkpoint_path(const std::filesystem::path& directory);
std::filesystem::path previous_checkpoint_path(const std::filesystem::path& directory);

/// Makes checkpoint.h5 the previous one as well. Call it between `seal` and `commit` of the next; at no moment is there no checkpoint.
void rotate_checkpoints(const std::filesystem::path& directory);

/// The checkpoint to resume from: checkpoint.h5, or the previous one where only that exists. UserError when there is none.
std::filesystem::path newest_checkpoint(const std::filesystem::path& directory);

}  // namespace millscope::output
