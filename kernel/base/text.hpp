// Whole files as text.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace millscope::base {

/// All bytes of a file. Throws UserError with the file and the system's reason: "… cannot be read (No such file or directory)".
std::string text_of(const std::filesystem::path& file);

/// The same where the caller has something better to say, or to do: nothing for a file that cannot be read.
std::optional<std::string> text_if_readable(const std::filesystem::path& file);

}  // namespace millscope::base
