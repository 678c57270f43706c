#include "kernel/base/text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "kernel/base/error.hpp"

namespace millscope::base {

std::optional<std::string> text_if_readable(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  try {
    std::string text;
    for (std::size_t more = 1 << 16, size = 0;; more = text.size()) {  // in few calls: a library with symbols has many megabytes
      text.resize(size + more);
      const auto read = static_cast<std::size_t>(in.rdbuf()->sgetn(text.data() + size, static_cast<std::streamsize>(more)));
      size += read;
      if (read == more) continue;
      text.resize(size);
      return text;
    }
  } catch (const std::ios_base::failure&) {  // a directory opens, and cannot be read
    return {};
  }
}

std::string text_of(const std::filesystem::path& file) {
  std::optional<std::string> text = text_if_readable(file);
  if (!text) throw UserError(fmt::format("{}: cannot be read ({})", file.string(), std::strerror(errno)));
  return std::move(*text);
}

}  // namespace millscope::base
