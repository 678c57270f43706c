// Cells of text in columns that stand below each other.
#pragma once

#include <string>
#include <vector>

namespace millscope::base {

using Row = std::vector<std::string>;

/// Each column to the left; rows may be short.
std::string columns_to_left(const std::vector<Row>& rows);

/// Two blanks, then the first column to the left and the others, numbers, to the right; rows may be short.
std::string columns_of_numbers(const std::vector<Row>& rows);

}  // namespace millscope::base
