// Cells of tables as CSV.
#pragma once

#include <string>

namespace millscope::output {

/// A text as a cell of a CSV file (RFC 4180): quoted where it must be.
std::string csv_cell(const std::string& text);

}  // namespace millscope::output
