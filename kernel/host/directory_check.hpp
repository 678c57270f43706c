// Whose files are trusted: code is loaded only from places that nobody else can write.
#pragma once

#include <string>

namespace millscope::host {

/// Throws UserError unless the directory or file belongs to the user or root and nobody else can write to it: no others, and no group but
/// the user's own (same name, no other members). The directories above, of the path without links, must be the same, for who writes to one
/// can put another in its place; a sticky one such as /tmp is fine, and so is one of root below /usr or /opt that a group may write to, as
/// Debian's /usr/local (group staff).
void require_private(const std::string& path);

}  // namespace millscope::host
