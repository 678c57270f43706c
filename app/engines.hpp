// The option that names another engine.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "app/commands.hpp"
#include "kernel/base/error.hpp"
#include "kernel/base/nearest.hpp"

namespace millscope::app {

inline void add_engine(Options& options) {
  options.add()("engine", boost::program_options::value<std::string>()->value_name("NAME"), "which engine: liggghts");
}

/// Throws base::UserError for a name that is no engine's.
inline void check_engine(const std::string& name) {
  const std::vector<std::string> known{"liggghts"};
  if (name != known.front()) throw base::UserError(fmt::format("--engine '{}' is not known; {}", name, base::suggestion(name, known)));
}

}  // namespace millscope::app
