#include "kernel/base/program.hpp"

#include <gnu/libc-version.h>

#include <algorithm>
#include <cassert>

#include "kernel/base/hash.hpp"
#include "kernel/base/program_tables.hpp"

namespace millscope::base {

std::string version() { return MILLSCOPE_VERSION; }

/// The millscope command has its own, app/commit.cmake; this one serves all other programs.
[[gnu::weak]] const char* commit() { return ""; }

std::string version_and_commit() {
  const std::string known = commit();
  return version() + (known.empty() ? " (commit not known: built outside a git checkout)" : " (commit " + known + ")");
}

ProgramParts program_parts(std::span<const std::string> folders) {
  Hash code;
  for (const std::string& folder : folders) {
    const std::vector<FolderDigest>& all = folder_digests();
    const auto found = std::find_if(all.begin(), all.end(), [&](const FolderDigest& d) { return d.folder == folder; });
    assert(found != all.end());
    code.add(folder).add_word(found->digest);
  }
  // The mathematical functions are those of the machine that runs, not of the one that built.
  const std::string libraries = std::string(kBuildLibraries) + ", glibc " + gnu_get_libc_version();
  return {{"code", code.text()}, {"compiler", kBuildCompiler}, {"flags", kBuildFlags}, {"libraries", libraries}};
}

const std::vector<std::string>& simulating_folders() { return kSimulatingFolders; }
const std::vector<std::string>& observing_folders() { return kObservingFolders; }

}  // namespace millscope::base
