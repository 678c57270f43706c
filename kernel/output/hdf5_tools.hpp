// What the HDF5 files of this room share: handles that close themselves, errors in words, attributes.
#pragma once

#include <hdf5.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace millscope::output::hdf5 {

/// An identifier with its closing function.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  ~Handle() { close(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// False when HDF5 could not write what was left.
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || closer_(id) >= 0;
  }

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

/// Before the first HDF5 call of any entry point: no messages on stderr, no writing at exit.
void prepare();

/// The text of the innermost error on HDF5's stack, and the errno in it (0: none).
struct Fault {
  std::string text;
  int error = 0;
};
Fault last_fault();

/// Throws the UserError for the last HDF5 failure on `file` while `doing` ("writing position").
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& doing);

/// Text of any length, UTF-8.
Handle text_type();

/// `handle`, or throws.
Handle checked(Handle handle, const std::filesystem::path& file, const std::string& doing);
void check(herr_t status, const std::filesystem::path& file, const std::string& doing);

/// The little-endian type in files, which is also that of memory on every machine that this program runs on.
template <class T>
hid_t type_of() {
  if constexpr (std::same_as<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::same_as<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::same_as<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::same_as<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::same_as<T, std::uint8_t>) return H5T_STD_U8LE;
  if constexpr (std::same_as<T, std::uint32_t>) return H5T_STD_U32LE;
  if constexpr (std::same_as<T, std::uint64_t>) return H5T_STD_U64LE;
}

/// Attributes; -1 or any failure is found by the caller's later flush, so these return nothing.
void set_attribute(hid_t object, const char* name, std::uint32_t value);
void set_attribute(hid_t object, const char* name, double value);
void set_attribute(hid_t object, const char* name, const std::string& value);
void set_attribute(hid_t object, const char* name, const std::vector<std::string>& values);

/// The u32 attribute, or `missing`.
std::uint32_t get_attribute(hid_t object, const char* name, std::uint32_t missing);
/// The text attribute, or "".
std::string get_text_attribute(hid_t object, const char* name);

/// Throws base::UserError unless the root says `format` with `schema_version`.
void require_schema(hid_t file, const std::filesystem::path& path, const std::string& format, std::uint32_t schema_version);
/// Writes what require_schema reads.
void stamp_schema(hid_t file, const std::string& format, std::uint32_t schema_version);

}  // namespace millscope::output::hdf5
