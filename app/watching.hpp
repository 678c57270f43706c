// `run --watch`: the page beside a run.
#pragma once

#include <filesystem>

namespace millscope::app {

class Options;

/// Starts a process that serves the page of OUT and prints its address; it ends with this one. Called before any thread is started.
void watch_beside(const std::filesystem::path& out, const Options& options);

}  // namespace millscope::app
