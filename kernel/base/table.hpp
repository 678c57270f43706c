// A table as a text file: CSV with a line of names. Cells stay text until a number is asked for, with the line it stands in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace millscope::base {

/// A column of numbers, and how finely they were written.
struct Column {
  std::vector<double> value;
  double half_digit = 0;  ///< half a unit of the last digit of the most finely written cell: what rounding may have changed
};

/// Half a unit of the last digit: "0.16" gives 0.005, "30" 0.5, "1.5e-3" 0.00005.
double half_digit_of(const std::string& text);

/// Comma-separated, quotes as in RFC 4180, lines that begin with '#' and empty lines apart.
class Table {
 public:
  /// Throws UserError with file:line for a file that cannot be read, no rows, names that are empty or stand twice, rows with more
  /// or fewer cells than names, quotes that do not end.
  static Table read(const std::filesystem::path& file);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& names() const { return names_; }
  std::size_t rows() const { return cells_.size(); }
  const std::string& cell(std::size_t row, std::size_t column) const { return cells_[row][column]; }
  /// "table.csv:7", for messages.
  std::string place(std::size_t row) const;

  bool has(const std::string& name) const;
  /// Throws UserError with the nearest name.
  std::size_t index_of(const std::string& name) const;
  /// Throws UserError with file:line for the first cell that is no finite number.
  Column numbers(std::size_t column) const;
  /// Some cell is a number: what else the column holds is then a gap, not words.
  bool has_number(std::size_t column) const;

 private:
  void read_line(const std::string& line, int number);
  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<int> line_;
};

}  // namespace millscope::base
