#include "studies/recording/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "studies/recording/heads.hpp"

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

constexpr std::string_view kExponents = "dDqQ";  // Fortran's, of double and of fourfold precision

/// A number that is written otherwise than in C: with a decimal comma, or Fortran's 1.2D+03. Up to what cannot belong to it.
const char* read_foreign(const char* p, const char* end, char decimal, double& value) {
  constexpr std::size_t kLongest = 64;
  std::array<char, kLongest> plain{};
  std::size_t size = 0;
  const char* at = p;
  for (; at != end && size < plain.size(); ++at, ++size) {
    const bool exponent = kExponents.find(*at) != std::string_view::npos;
    if (*at != decimal && !exponent && std::string_view("+-.0123456789eE").find(*at) == std::string_view::npos) break;
    plain[size] = *at == decimal ? '.' : exponent ? 'e' : *at;
    if (exponent && at + 1 != end && at[1] == '+') ++at;
  }
  const auto [behind, error] = std::from_chars(plain.data(), plain.data() + size, value);
  if (error == std::errc::result_out_of_range) value = HUGE_VAL;
  return error == std::errc::invalid_argument || behind != plain.data() + size ? nullptr : at;
}

bool read_value(const char*& p, const char* end, char decimal, double& value) {
  const bool quoted = p != end && *p == '"';
  if (quoted) ++p;
  if (p != end && *p == '+') ++p;
  auto [behind, error] = std::from_chars(p, end, value);
  const bool foreign = behind != end && ((decimal != '.' && *behind == decimal) || kExponents.find(*behind) != std::string_view::npos);
  if (foreign) behind = read_foreign(p, end, decimal, value);
  if (behind == nullptr || (!foreign && error == std::errc::invalid_argument)) return false;
  if (!foreign && error == std::errc::result_out_of_range) value = HUGE_VAL;
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
    if (layout.label && *layout.label >= std::ssize(target_)) target_.resize(*layout.label + 1);
  }

  /// Why the line is no row; nullptr: it is one.
  const char* read(const char* p, const char* end, std::array<double, kQuantities>& values, std::string_view& label) const {
    const int wanted = static_cast<int>(target_.size()), columns = std::max(wanted, layout_.least_columns);
    for (int column = 0; column < columns; ++column) {
      p = skip_blanks(p, end);
      if (p == end && column == layout_.label && layout_.separator != ' ') {
        label = {};
        continue;
      }
      if (p == end) return "has too few columns";
      const std::optional<int> quantity = column < wanted ? target_[column] : std::nullopt;
      if (!quantity) {
        const char* const begin = p;
        p = skip_value(p, end, layout_.separator);
        if (column == layout_.label) label = {begin, static_cast<std::size_t>(p - begin)};
      } else if (!read_value(p, end, layout_.decimal, values[*quantity])) {
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
std::size_t decimals(std::string_view line, char decimal) {
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last == std::string_view::npos) return 0;
  const std::size_t begin = line.find_last_of(decimal == ',' ? " \t;" : " \t,;", last);
  const std::string_view value = line.substr(begin == std::string_view::npos ? 0 : begin + 1, last - begin);
  const std::size_t point = value.find(decimal);
  return point == std::string_view::npos ? 0 : value.size() - point;
}

void append(Run& rows, const Layout& layout, const std::array<double, kQuantities>& values) {
  rows.time.push_back(values[kTime]);
  for (std::size_t axis = 0; axis < 3; ++axis) rows.position[axis].push_back(values[kX + axis]);
  if (layout.column[kError]) rows.spread.push_back(values[kError]);
  if (layout.column[kEvents]) rows.events.push_back(std::llround(values[kEvents]));
}

void reserve(Run& rows, const Layout& layout, std::size_t count) {
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

/// Takes labels in, of which neighbours are often the same.
class Labels {
 public:
  explicit Labels(Table& table) : table_(table) {}
  void add(std::string_view text) {
    const std::string_view plain = trimmed(text);
    if (table_.label.empty() || plain != table_.labels[table_.label.back()]) {
      const auto [at, fresh] = places_.try_emplace(std::string(plain), table_.labels.size());
      if (fresh) table_.labels.emplace_back(plain);
      last_ = at->second;
    }
    table_.label.push_back(last_);
  }

 private:
  Table& table_;
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t last_ = 0;
};

}  // namespace

Layout ctrack_layout() {
  Layout layout;
  layout.column = {0, 1, 2, 3, 4, 7};
  layout.divisor = {1000, 1000, 1000, 1000, 1000, 1};
  layout.header_lines = 9;
  layout.least_columns = 8;
  return layout;
}

Table read_rows(std::string_view text, const Layout& layout, FirstFault& fault) {
  const RowReader reader(layout);
  Table table;
  Run& rows = table.rows;
  RunReport& report = rows.report;
  Labels labels(table);
  std::string_view label;
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
    const char* why = reader.read(first, stop, values, label);
    if (why != nullptr && rows.size() == 0 && (number <= layout.header_lines || !begins_with_number(first, stop))) continue;
    if (why == nullptr && !whole && decimals(line, layout.decimal) < decimals(above, layout.decimal)) why = "ends within a number";
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
      if (layout.label) labels.add(label);
      above = line;
    }
  }
  report.used = rows.size();
  return table;
}

}  // namespace millscope::recording
