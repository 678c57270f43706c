// From the lines of a text file to numbers in SI. For the files of this room.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/recording/recording.hpp"

namespace millscope::recording {

enum Quantity { kTime, kX, kY, kZ, kError, kEvents, kQuantities };

/// Which column holds what. Column numbers count from 0.
struct Layout {
  std::array<std::optional<int>, kQuantities> column;  ///< nothing: the file has none
  /// SI value = number · multiplier / divisor: one rounding for mm and ms, where a factor of 0.001 makes two.
  std::array<double, kQuantities> multiplier{1, 1, 1, 1, 1, 1};
  std::array<double, kQuantities> divisor{1, 1, 1, 1, 1, 1};
  std::optional<int> label;      ///< column that says whose row it is
  char decimal = '.';            ///< or a comma
  char separator = ' ';          ///< ' ': any run of blanks and tabs
  std::size_t header_lines = 0;  ///< lines at the top that are no rows unless they read as one
  std::size_t skip_lines = 0;    ///< lines at the top that are no rows whatever they hold
  int least_columns = 0;         ///< a row with fewer is unreadable
};

/// The layout of a tracker's `.a` file: t (ms), x, y, z (mm), u (mm), 0, 0, n.
Layout ctrack_layout();

/// What a file holds, row by row in the order of the file.
struct Table {
  Run rows;                         ///< with the counts of lines that are none
  std::vector<std::size_t> label;   ///< of each row, its place in `labels`; empty where there is no such column
  std::vector<std::string> labels;  ///< as written, in the order in which they come
};

/// Why a line with decimal commas is no row where others have points: the one reason with a remedy of its own.
inline constexpr const char* kDecimalCommas = "has decimal commas";

/// The first line that was set aside, for messages.
struct FirstFault {
  std::size_t line = 0;  ///< 0: none
  std::string text;
  std::string why;
};

/// Reads every row; counts rows, unreadable and not_finite.
Table read_rows(std::string_view text, const Layout& layout, FirstFault& fault);

}  // namespace millscope::recording
