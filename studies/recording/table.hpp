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
  char separator = ' ';          ///< ' ': any run of blanks and tabs
  std::size_t header_lines = 0;  ///< lines at the top that are no rows unless they read as one
  std::size_t skip_lines = 0;    ///< lines at the top that are no rows whatever they hold
  int least_columns = 0;         ///< a row with fewer is unreadable
};

/// The layout of a tracker's `.a` file: t (ms), x, y, z (mm), u (mm), 0, 0, n.
Layout ctrack_layout();

/// What a file holds, row by row in the order of the file.
struct Rows {
  std::vector<double> time;
  std::array<std::vector<double>, 3> position;
  std::vector<double> spread;        ///< empty where there is no such column
  std::vector<std::int64_t> events;  ///< empty where there is no such column
  std::size_t size() const { return time.size(); }
};

/// Why a line with decimal commas is no row: the one reason with a remedy of its own.
inline constexpr const char* kDecimalCommas = "has decimal commas";

/// The first line that was set aside, for messages.
struct FirstFault {
  std::size_t line = 0;  ///< 0: none
  std::string text;
  std::string why;
};

/// Reads every row; counts rows, unreadable and not_finite in `report`.
Rows read_rows(std::string_view text, const Layout& layout, RunReport& report, FirstFault& fault);

}  // namespace millscope::recording
