// Files that a document names and that are read later.
#pragma once

#include <string>

#include "kernel/config/document.hpp"

namespace millscope::config {

/// As resolve_file; refused now, at its line, where there is no such file or it cannot be opened. `remedy`: what to do then.
std::string existing_file(const Node& node, const std::string& remedy = "check the path");

}  // namespace millscope::config
