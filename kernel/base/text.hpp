// Whole files as text; text without the blanks around it, in small letters.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace millscope::base {

/// All bytes of a file. Throws UserError with the file and the system's reason: "… cannot be read (No such file or directory)".
std::string text_of(const std::filesystem::path& file);

/// The same where the caller has something better to say, or to do: nothing for a file that cannot be read.
std::optional<std::string> text_if_readable(const std::filesystem::path& file);

/// `text` without `blanks` at its ends.
inline std::string trimmed(std::string_view text, std::string_view blanks = " \t") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

/// `text` with its ASCII letters small.
inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

}  // namespace millscope::base
