// A whole text file in memory, unpacked where it is gzipped.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace millscope::recording {

/// The bytes of a file and the view of them.
class TextFile {
 public:
  /// A gzip file (known by its first bytes, whatever its name) is inflated, UTF-16 (known by its byte-order mark, or by a zero in every
  /// second byte) becomes UTF-8. Throws base::UserError when the file cannot be opened, is no
  /// file, or is a damaged or cut gzip file.
  explicit TextFile(const std::filesystem::path& file);
  std::string_view text() const { return text_; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::string inflated_;
  std::string_view text_;
};

}  // namespace millscope::recording
