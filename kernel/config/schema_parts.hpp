// For the schemas of files that may include others.
#pragma once

#include <nlohmann/json.hpp>

namespace millscope::config {

/// The schema of whole files → that of whole files and of parts. A file with `include`, or without `schema_version`, is a part: nothing is
/// required of it, and `key: ~` may take away what it inherits. Types, choices and known keys are held to either way.
nlohmann::json with_parts(nlohmann::json whole);

}  // namespace millscope::config
