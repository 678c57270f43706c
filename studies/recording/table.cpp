#include "studies/recording/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace millscope::recording {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && is_blank(*p)) ++p;
  return p;
}

/// Steps over the separator behind a value. False when something else stands there.
bool step_over(const char*& p, const char* end, char separator) {
  const char* const behind = p;
  p = skip_blanks(p, end);
  if (separator == ' ') return p == end || p != behind;
  if (p == end) return true;
  if (*p != separator) return false;
  ++p;
  return true;
}

const char* skip_value(const char* p, const char* end, char separator) {
  if (separator == ' ') {
    while (p != end && !is_blank(*p)) ++p;
    return p;
  }
  const void* found = std::memchr(p, separator, end - p);
  return found == nullptr ? end : static_cast<const char*>(found);
}

bool read_value(const char*& p, const char* end, double& value) {
  const bool quoted = p != end && *p == '"';
  if (quoted) ++p;
  if (p != end && *p == '+') ++p;
  const auto [behind, error] = std::from_chars(p, end, value);
  if (error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) value = HUGE_VAL;
  p = behind;
  if (quoted && (p == end || *p++ != '"')) return false;
  return true;
}

class RowReader {
 public:
  explicit RowReader(const Layout& layout) : layout_(layout) {
    for (int quantity = 0; quantity < kQuantities; ++quantity) {
      const std::optional<int> column = layout.column[quantity];
      if (!column) continue;
      if (*column >= std::ssize(target_)) target_.resize(*column + 1);
      target_[*column] = quantity;
    }
  }

  /// Why the line is no row; nullptr: it is one.
  const char* read(const char* p, const char* end, std::array<double, kQuantities>& values) const {
    const int wanted = static_cast<int>(target_.size()), columns = std::max(wanted, layout_.least_columns);
    for (int column = 0; column < columns; ++column) {
      p = skip_blanks(p, end);
      if (p == end) return "has too few columns";
      const std::optional<int> quantity = column < wanted ? target_[column] : std::nullopt;
      if (!quantity) {
        p = skip_value(p, end, layout_.separator);
      } else if (!read_value(p, end, values[*quantity])) {
        return "has something else than a number";
      }
      if (!step_over(p, end, layout_.separator)) {
        const bool comma = end - p > 1 && *p == ',' && p[1] >= '0' && p[1] <= '9';
        return comma ? kDecimalCommas : "has something else than a number";
      }
    }
    for (std::size_t k = 0; k < kQuantities; ++k) {
      if (layout_.column[k]) values[k] = values[k] * layout_.multiplier[k] / layout_.divisor[k];
    }
    return nullptr;
  }

 private:
  const Layout& layout_;
  std::vector<std::optional<int>> target_;  // of each column: the quantity
};

bool is_comment(const char* p, const char* end) { return *p == '#' || *p == '%' || *p == '!' || (*p == '/' && end - p > 1 && p[1] == '/'); }

/// A line before the first row that begins with a word is a head.
bool begins_with_number(const char* p, const char* end) {
  if (*p == '"') ++p;
  if (p != end && (*p == '+' || *p == '-')) ++p;
  if (p != end && *p == '.') ++p;
  return p != end && *p >= '0' && *p <= '9';
}

void note(FirstFault& fault, std::size_t line, std::string_view text, const char* why) {
  if (fault.line != 0) return;
  fault = {line, std::string(text.substr(0, 60)), why};
}

/// The last line without a line end may be cut within a number: it then has fewer characters behind the point than the line above.
std::size_t decimals(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last == std::string_view::npos) return 0;
  const std::size_t begin = line.find_last_of(" \t,;", last);
  const std::string_view value = line.substr(begin == std::string_view::npos ? 0 : begin + 1, last - begin);
  const std::size_t point = value.find('.');
  return point == std::string_view::npos ? 0 : value.size() - point;
}

void append(Rows& rows, const Layout& layout, const std::array<double, kQuantities>& values) {
  rows.time.push_back(values[kTime]);
  for (std::size_t axis = 0; axis < 3; ++axis) rows.position[axis].push_back(values[kX + axis]);
  if (layout.column[kError]) rows.spread.push_back(values[kError]);
  if (layout.column[kEvents]) rows.events.push_back(std::llround(values[kEvents]));
}

void reserve(Rows& rows, const Layout& layout, std::size_t count) {
  rows.time.reserve(count);
  for (auto& component : rows.position) component.reserve(count);
  if (layout.column[kError]) rows.spread.reserve(count);
  if (layout.column[kEvents]) rows.events.reserve(count);
}

bool all_finite(const Layout& layout, const std::array<double, kQuantities>& values) {
  for (std::size_t k = 0; k < kQuantities; ++k) {
    if (layout.column[k] && !std::isfinite(values[k])) return false;
  }
  return true;
}

}  // namespace

Layout ctrack_layout() {
  Layout layout;
  layout.column = {0, 1, 2, 3, 4, 7};
  layout.divisor = {1000, 1000, 1000, 1000, 1000, 1};
  layout.header_lines = 9;
  layout.least_columns = 8;
  return layout;
}

Rows read_rows(std::string_view text, const Layout& layout, RunReport& report, FirstFault& fault) {
  const RowReader reader(layout);
  Rows rows;
  std::array<double, kQuantities> values{};
  std::string_view above;
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  for (const char* p = text.data(); p != end;) {
    ++number;
    const char* const begin = p;
    const auto* stop = static_cast<const char*>(std::memchr(p, '\n', end - p));
    const bool whole = stop != nullptr;
    if (!whole) stop = end;
    p = whole ? stop + 1 : end;
    const char* const first = skip_blanks(begin, stop);
    if (number <= layout.skip_lines || first == stop || is_comment(first, stop)) continue;
    const std::string_view line(begin, static_cast<std::size_t>(stop - begin));
    const char* why = reader.read(first, stop, values);
    if (why != nullptr && rows.size() == 0 && (number <= layout.header_lines || !begins_with_number(first, stop))) continue;
    if (why == nullptr && !whole && decimals(line) < decimals(above)) why = "ends within a number";
    ++report.rows;
    if (why != nullptr) {
      ++report.unreadable;
      note(fault, number, line, why);
    } else if (!all_finite(layout, values)) {
      ++report.not_finite;
      note(fault, number, line, "is not finite");
    } else {
      if (rows.size() == 0) reserve(rows, layout, text.size() / (line.size() + 1) + 16);
      append(rows, layout, values);
      above = line;
    }
  }
  return rows;
}

}  // namespace millscope::recording
