// The options that let another engine play a case.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "app/commands.hpp"

namespace millscope::app {

inline void add_engine(Options& options) {
  options.add()("engine", boost::program_options::value<std::string>()->value_name("NAME"),
                "another program that moves the beads: liggghts (run.engine of the case)");
}

/// What is laid on the case: --set, and what stands in options of their own.
inline std::vector<std::string> settings_of(const Options& options) {
  std::vector<std::string> settings = options.list("set");
  if (options.has("engine")) settings.push_back("run.engine=" + options.text("engine"));
  if (options.has("ranks")) settings.push_back(fmt::format("run.ranks={}", options.integer("ranks")));
  return settings;
}

}  // namespace millscope::app
