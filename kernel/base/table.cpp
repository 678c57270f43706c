#include "kernel/base/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "kernel/base/error.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"

namespace millscope::base {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw UserError(fmt::format("{}: is a directory; give a table (.csv)", file.string()));
  std::string bytes = text_of(file);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);  // byte order mark of spreadsheets
  if (bytes.find('\0') != std::string::npos) throw UserError(fmt::format("{}: is no text file; give a table (.csv)", file.string()));
  return bytes;
}

/// The cells of a line; a quoted cell may hold commas and doubled quotes.
std::vector<std::string> split(const std::string& line, const Location& where) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  if (quoted) throw UserError(where, "a quote is opened and not closed; cells end with their line");
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

double half_digit_of(const std::string& text) {
  const std::size_t exponent = std::min(text.find_first_of("eE"), text.size()), point = text.find('.');
  const int decimals = point < exponent ? static_cast<int>(exponent - point) - 1 : 0;
  const int power = exponent < text.size() ? std::atoi(text.c_str() + exponent + 1) : 0;
  return 0.5 * std::pow(10.0, power - decimals);
}

void Table::read_line(const std::string& line, int number) {
  const Location where{file_, number};
  std::vector<std::string> cells = split(line, where);
  if (names_.empty()) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (cells[c].empty()) throw UserError(where, fmt::format("column {} has no name; the first line names the columns", c + 1));
      if (has(cells[c])) throw UserError(where, fmt::format("column '{}' stands twice; rename one", cells[c]));
      names_.push_back(cells[c]);
    }
    return;
  }
  if (cells.size() != names_.size()) {
    throw UserError(where,
                    fmt::format("{} cells for {} columns; separate by commas, with '.' as the decimal point", cells.size(), names_.size()));
  }
  cells_.push_back(std::move(cells));
  line_.push_back(number);
}

Table Table::read(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  Table table;
  table.file_ = file.string();
  int number = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    std::string line = bytes.substr(at, end - at);
    at = end + 1;
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    table.read_line(line, number);
  }
  if (table.names_.empty()) throw UserError(fmt::format("{}: is empty; the first line names the columns", table.file_));
  if (table.cells_.empty()) throw UserError(fmt::format("{}: names columns and has no rows", table.file_));
  return table;
}

std::string Table::place(std::size_t row) const { return Location{file_, line_[row]}.text(); }

bool Table::has(const std::string& name) const { return std::find(names_.begin(), names_.end(), name) != names_.end(); }

std::size_t Table::index_of(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) throw UserError(fmt::format("{}: has no column '{}'; {}", file_, name, suggestion(name, names_)));
  return found - names_.begin();
}

Column Table::numbers(std::size_t column) const {
  Column numbers;
  numbers.half_digit = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string& text = cells_[row][column];
    const auto value = number_of(text);
    if (!value) {
      throw UserError(Location{file_, line_[row]},
                      fmt::format("{} '{}' is no finite number; repeat the run or remove its line", names_[column], text));
    }
    numbers.value.push_back(*value);
    numbers.half_digit = std::min(numbers.half_digit, half_digit_of(text));
  }
  return numbers;
}

bool Table::has_number(std::size_t column) const {
  return std::any_of(cells_.begin(), cells_.end(), [column](const auto& row) { return number_of(row[column]).has_value(); });
}

}  // namespace millscope::base
