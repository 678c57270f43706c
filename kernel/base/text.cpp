#include "kernel/base/text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "kernel/base/error.hpp"

namespace millscope::base {

std::optional<std::string> text_if_readable(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  try {
    return std::string{std::istreambuf_iterator<char>(in), {}};
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
