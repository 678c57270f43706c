// Text in columns. For the files of this room.
#pragma once

#include <string>
#include <vector>

namespace millscope::doe {

using Row = std::vector<std::string>;

/// The first column to the left, the others to the right; rows may be short.
std::string aligned(const std::vector<Row>& rows);

}  // namespace millscope::doe
