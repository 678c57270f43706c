// The lines above the first row of a table: what they say of its columns. For the files of this room.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/recording/description.hpp"

namespace millscope::recording {

using Words = std::vector<std::string_view>;

/// Without blanks and quotes around it.
std::string_view trimmed(std::string_view text);

/// The words between separators, without blanks and quotes around them.
Words split(std::string_view line, char separator);

/// The first lines of a file: up to the first row, and that row.
struct Top {
  std::vector<std::string_view> head;  ///< trimmed, comment marks too
  std::string_view row;
  std::size_t row_line = 0;  ///< from 1; 0: no row
  char separator = ' ';
  char decimal = '.';
};
Top top_of(std::string_view text, const Description& description);

/// The column whose head says that it tells beads apart: label, tracer, bead, …; nothing where there is none.
std::optional<int> label_of_heads(const Top& top);

/// A line above the first row, in words.
struct HeadLine {
  std::size_t line = 0;  ///< from 1
  Words words;
};

/// The heads above the columns: as many words as the row has columns, if possible such that name t, x, y and z; empty where there are none.
HeadLine heads_of(const Top& top);

/// 'a', 'b', for messages.
std::string listed(const Words& words);

/// The columns as their heads name them; nothing where there are no heads. Throws base::UserError for heads that do not say where t, x, y
/// and z are: they must not be passed over.
std::vector<ColumnEntry> entries_of_heads(const Top& top, const std::filesystem::path& file);

/// Without a unit: the usual one. Throws std::invalid_argument.
ColumnEntry entry_of(int number, Quantity quantity, const std::string& unit);

}  // namespace millscope::recording
