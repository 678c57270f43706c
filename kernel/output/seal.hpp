// The 32 bytes at the end of an archive that vouch for all bytes before them.
#pragma once

#include <filesystem>
#include <string>

namespace millscope::output {

/// Appends the seal to the finished file; syncs nothing. Throws base::UserError when it cannot be written.
void append_seal(const std::filesystem::path& file);

/// "" when the seal is there and right; otherwise what is wrong, as a clause ("is cut short", …).
std::string seal_fault(const std::filesystem::path& file);

}  // namespace millscope::output
