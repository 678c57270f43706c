// A case played by the engine that it names. Each engine has a folder of its own here.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/config/case.hpp"
#include "kernel/host/registry.hpp"
#include "kernel/run/simulation.hpp"

namespace millscope::engine {

/// Throws base::UserError for a case that names no engine that is known.
void require_known(const config::Case& c);

/// Throws base::UserError where the mill cannot be put together; a line for each obstacle where the engine that the case names cannot play it
/// or is not installed.
void require_playable(const config::Case& c, const host::Registry& registry);

/// The version of the engine that a case names, as the engine itself tells it, and of what translates for it here. Throws base::UserError
/// where it is not installed.
std::string version_of(const config::Case& c);

/// Runs a case from its start, by the engine that it names. Throws base::UserError.
run::Outcome run_case(const std::string& case_file, const host::Registry& registry, const run::RunOptions& options);

/// Whether a folder is one in which another engine runs or ran.
bool is_run(const std::filesystem::path& out);

/// What a run of another engine goes on from at best; "": there is nothing.
std::filesystem::path restart_file(const std::filesystem::path& out);

/// Continues the run of `options.output`, whoever makes it. Throws base::UserError.
run::Outcome resume_run(const host::Registry& registry, const run::RunOptions& options);

}  // namespace millscope::engine
