// What this program is: its version, its commit, and what can change the numbers that it computes.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace millscope::base {

/// "0.1.0"
std::string version();
/// What git called the sources at the last build, "-dirty" behind it where they differed from that commit. Empty where they were no git
/// checkout, and in every program but the millscope command, so that a commit does not link all tests again.
const char* commit();
/// "0.1.0 (commit 1a2b3c4d5e6f)", or that no commit is known.
std::string version_and_commit();

/// "code", "compiler", "flags" and "libraries", each with a text that differs where the numbers may. `folders`: whose code counts, of those
/// that the build knows.
using ProgramParts = std::map<std::string, std::string>;
ProgramParts program_parts(std::span<const std::string> folders);

/// The folders that a simulation's numbers come from, its plugins apart.
const std::vector<std::string>& simulating_folders();
/// Those that what is seen of a simulation comes from besides: camera, splines, analyzers' host, summaries.
const std::vector<std::string>& observing_folders();

}  // namespace millscope::base
