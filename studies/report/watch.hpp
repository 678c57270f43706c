// The report page of a folder that is still being written, served to this machine alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "kernel/host/registry.hpp"
#include "studies/report/sections.hpp"

namespace millscope::report {

struct WatchOptions {
  std::uint16_t port = 0;                               ///< 0: any free one
  SectionOptions sections;                              ///< what the page shows
  std::function<void(const std::string& address)> say;  ///< called once, when the page can be opened
  std::function<bool()> goes_on;                        ///< asked every second; false ends the serving
};

/// Serves the page and its data at 127.0.0.1 under an address with a random token; nothing else, nothing to other machines, and nothing
/// can be changed through it. Returns when `goes_on` says false. Throws base::UserError when the port is taken.
void watch(const std::filesystem::path& out, const host::Registry& registry, const WatchOptions& options);

/// Whether a run or a study holds this folder, or one of those below it.
bool is_going_on(const std::filesystem::path& out);

/// 128 random bits of the operating system's, hexadecimal.
std::string random_token();

}  // namespace millscope::report
