// Single values of the tree as numbers, flags, choices and vectors.
#include <fmt/format.h>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/units.hpp"

namespace millscope::config {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Length of the decimal number at the start of `text`, 0 if there is none.
std::size_t number_length(std::string_view text) {
  const std::size_t sign = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const bool begins =
      text.size() > sign && (is_digit(text[sign]) || (text[sign] == '.' && text.size() > sign + 1 && is_digit(text[sign + 1])));
  if (!begins) return 0;
  double ignored = 0;
  const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), ignored);
  return error == std::errc::invalid_argument ? 0 : end - text.data();
}

std::string example(std::string_view si_unit) {
  if (si_unit == "1" || si_unit.empty()) return "such as 0.5 or 50 %";
  if (si_unit == "rad/s") return "in rad/s, e.g. 6 rad/s or 58 rpm";
  return fmt::format("in {}", si_unit);
}

std::string with_unit(double value, std::string_view si_unit) {
  return si_unit == "1" || si_unit.empty() ? number_text(value) : fmt::format("{} {}", number_text(value), si_unit);
}

std::string allowed(const Range& range, std::string_view si_unit) {
  const std::string low = with_unit(range.low, si_unit), high = with_unit(range.high, si_unit);
  if (std::isinf(range.high)) return fmt::format("{} {}", range.open_low ? "above" : "at least", low);
  if (std::isinf(range.low)) return fmt::format("{} {}", range.open_high ? "below" : "at most", high);
  if (range.open_low && range.open_high) return fmt::format("above {} and below {}", low, high);
  if (range.open_low) return fmt::format("above {} and at most {}", low, high);
  if (range.open_high) return fmt::format("at least {} and below {}", low, high);
  return fmt::format("from {} to {}", low, high);
}

double to_si(const Node& node, const Quantity& quantity, std::string_view si_unit) {
  const Dimension expected = parse_unit(si_unit).dimension;
  if (!quantity.has_unit) return quantity.number;
  if (quantity.unit.dimension != expected) {
    node.fail(fmt::format("is '{}' ({}); expected: {} {}", node.text(), dimension_name(quantity.unit.dimension), dimension_name(expected),
                          example(si_unit)));
  }
  return quantity.unit.to_si(quantity.number);
}

Unit unit_of(const Node& node, const std::string& text) {
  try {
    return parse_unit(text);
  } catch (const std::invalid_argument& e) {
    node.fail(fmt::format("is '{}': {}", node.text(), e.what()));
  }
}

}  // namespace

Range any_number() { return {-kInfinity, kInfinity}; }
Range positive(const char* reason) { return {0, kInfinity, true, false, reason}; }
Range not_negative(const char* reason) { return {0, kInfinity, false, false, reason}; }
Range between(double low, double high, const char* reason) { return {low, high, false, false, reason}; }

Quantity read_quantity(const Node& node) {
  const std::string text = base::trimmed(node.text(), " ");
  const std::size_t length = number_length(text);
  if (length == 0) node.fail(fmt::format("is '{}'; a number is expected, bare (SI) or with a unit such as '5 mm'", node.text()));
  const bool zero_first = length > 1 && text[text[0] == '-' || text[0] == '+' ? 1 : 0] == '0';
  const std::size_t second = text[0] == '-' || text[0] == '+' ? 2 : 1;
  if (zero_first && second < length && is_digit(text[second])) node.fail(fmt::format("is '{}'; write it without the leading 0", text));
  Quantity quantity;
  const std::size_t sign = text[0] == '+' ? 1 : 0;
  const auto result = std::from_chars(text.data() + sign, text.data() + length, quantity.number);
  if (result.ec != std::errc() || !std::isfinite(quantity.number)) node.fail(fmt::format("is '{}', which no double holds", text));
  const std::string rest = base::trimmed(std::string_view(text).substr(length), " ");
  if (rest.empty()) return quantity;
  if (rest[0] == ',' || rest[0] == '_') node.fail(fmt::format("is '{}'; write the number with a decimal point and no separators", text));
  quantity.has_unit = true;
  quantity.unit = unit_of(node, rest);
  return quantity;
}

void check_range(const Node& node, double value, std::string_view si_unit, const Range& range) {
  const bool above = range.open_low ? value > range.low : value >= range.low;
  const bool below = range.open_high ? value < range.high : value <= range.high;
  if (above && below && std::isfinite(value)) return;
  const std::string reason = range.reason[0] != '\0' ? fmt::format("; {}", range.reason) : "";
  node.fail(fmt::format("is {}; it must be {}{}", with_unit(value, si_unit), allowed(range, si_unit), reason));
}

double read_number(const Node& node, std::string_view si_unit, const Range& range) {
  const double value = to_si(node, read_quantity(node), si_unit);
  check_range(node, value, si_unit, range);
  return value;
}

long long read_integer(const Node& node, const Range& range) {
  const Quantity quantity = read_quantity(node);
  if (quantity.has_unit) node.fail(fmt::format("is '{}'; a whole number without unit is expected", node.text()));
  check_range(node, quantity.number, "1", range);
  constexpr double largest = 9007199254740992.0;  // 2^53: beyond it doubles skip whole numbers
  if (quantity.number != std::floor(quantity.number) || std::fabs(quantity.number) > largest) {
    node.fail(fmt::format("is '{}'; a whole number is expected", node.text()));
  }
  return static_cast<long long>(quantity.number);
}

bool read_flag(const Node& node) {
  const std::string& text = node.text();
  if (text == "true") return true;
  if (text == "false") return false;
  node.fail(fmt::format("is '{}'; write true or false", text));
}

std::string read_choice(const Node& node, std::string_view choices) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= choices.size();) {
    const std::size_t end = std::min(choices.find('|', begin), choices.size());
    words.emplace_back(choices.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const std::string& word : words) {
    if (word == node.text()) return word;
  }
  const std::string near = base::nearest(node.text(), words);
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  node.fail(fmt::format("is '{}'; it must be one of {}{}", node.text(), list, near.empty() ? "" : "; did you mean '" + near + "'?"));
}

std::array<double, 3> read_vector(const Node& node, std::string_view si_unit, const Range& range) {
  const std::vector<Node> items = node.items();
  const bool unit_after = items.size() == 4;
  if (items.size() != 3 && !unit_after) node.fail(fmt::format("has {} components; write [x, y, z]", items.size()));
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    Quantity quantity = read_quantity(items[i]);
    if (unit_after) {
      if (quantity.has_unit) items[i].fail("has a unit and the vector ends with one; keep one of them");
      quantity.has_unit = true;
      quantity.unit = unit_of(items[3], items[3].text());
    }
    result[i] = to_si(items[unit_after ? 3 : i], quantity, si_unit);
    check_range(items[i], result[i], si_unit, range);
  }
  return result;
}

std::string number_text(double value) {
  if (value == std::floor(value) && std::fabs(value) < 1e15) return fmt::format("{:.0f}", value == 0 ? 0.0 : value);
  return fmt::format("{}", value);
}

}  // namespace millscope::config
