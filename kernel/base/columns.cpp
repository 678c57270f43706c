#include "kernel/base/columns.hpp"

#include <algorithm>

namespace millscope::base {
namespace {

/// As a reader counts them: the bytes that begin a letter.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string aligned(const std::vector<Row>& rows, const std::string& indent, bool numbers) {
  std::vector<std::size_t> width;
  for (const Row& row : rows) {
    width.resize(std::max(width.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], letters(row[c]));
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(width[c] - letters(row[c]), ' ');
      line += (c == 0 ? indent : "  ") + (numbers && c > 0 ? space + row[c] : row[c] + space);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::string columns_to_left(const std::vector<Row>& rows) { return aligned(rows, "", false); }

std::string columns_of_numbers(const std::vector<Row>& rows) { return aligned(rows, "  ", true); }

}  // namespace millscope::base
