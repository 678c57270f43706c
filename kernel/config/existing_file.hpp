// Files that a document names and that are read later.
#pragma once

#include <string>
#include <vector>

#include "kernel/config/document.hpp"

namespace millscope::config {

/// As resolve_file; refused now, at its line, where there is no such file or it cannot be opened. `remedy`: what to do then.
std::string existing_file(const Node& node, const std::string& remedy = "check the path");

/// As resolve_file; with `*` or `?` in its name all files that match, by name. Refused at its line where none does.
std::vector<std::string> matching_files(const Node& node);

}  // namespace millscope::config
