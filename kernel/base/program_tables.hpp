// What is written while millscope is built; for the files of this room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace millscope::base {

/// A folder of the source tree and the digest of its code.
struct FolderDigest {
  std::string folder;
  std::uint64_t digest = 0;
};

const std::vector<FolderDigest>& folder_digests();

/// Name and version, as the build found them.
extern const char* const kBuildCompiler;
extern const char* const kBuildFlags;
extern const char* const kBuildLibraries;

/// kernel/base/CMakeLists.txt lists them.
extern const std::vector<std::string> kSimulatingFolders, kObservingFolders;

}  // namespace millscope::base
