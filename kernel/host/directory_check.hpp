// Whose files are trusted: code is loaded only from places that nobody else can write.
#pragma once

#include <string>

namespace millscope::host {

/// Throws UserError unless the directory or file belongs to the user or root and neither group nor others can write to it. Directories
/// above are checked for others' writing only (a sticky one such as /tmp is fine).
void require_private(const std::string& path);

}  // namespace millscope::host
