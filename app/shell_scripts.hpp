// What the shells run at a press of the tabulator.
#pragma once

#include <optional>
#include <string_view>

namespace millscope::app {

/// The script for "bash", "zsh" or "fish"; nothing for another word.
std::optional<std::string_view> shell_script(std::string_view shell);

}  // namespace millscope::app
