// `millscope plugin new KIND NAME`: an out-of-tree plugin project from the SDK's template.
#pragma once

#include <string>
#include <string_view>

#include "millscope/abi.hpp"

namespace millscope::host {

/// Writes the project `parent/name` (CMakeLists.txt, name.cpp, test, README.md) and returns its path. Throws UserError for a bad name, an
/// existing target, a template that is not installed.
std::string scaffold(Kind kind, std::string_view name, const std::string& parent = ".");

/// Where the templates are: beside the executable (../share/millscope/template), or in the source tree of this build.
std::string template_directory();

}  // namespace millscope::host
