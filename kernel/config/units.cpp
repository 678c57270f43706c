// Units: symbols, prefixes, powers, and the names of what they measure.
#include "kernel/config/units.hpp"

#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace millscope::config {
namespace {

struct Symbol {
  std::string_view name;
  Dimension dimension;  // m, kg, s, rad, K, fraction of critical speed
  double factor;
  int decade;
  bool prefixable;
};

constexpr double kPi = std::numbers::pi;
constexpr Symbol kSymbols[] = {
    {"m", {1, 0, 0, 0, 0, 0}, 1, 0, true},
    {"g", {0, 1, 0, 0, 0, 0}, 1, -3, true},
    {"s", {0, 0, 1, 0, 0, 0}, 1, 0, true},
    {"min", {0, 0, 1, 0, 0, 0}, 60, 0, false},
    {"h", {0, 0, 1, 0, 0, 0}, 3600, 0, false},
    {"N", {1, 1, -2, 0, 0, 0}, 1, 0, true},
    {"Pa", {-1, 1, -2, 0, 0, 0}, 1, 0, true},
    {"bar", {-1, 1, -2, 0, 0, 0}, 1, 5, true},
    {"J", {2, 1, -2, 0, 0, 0}, 1, 0, true},
    {"W", {2, 1, -3, 0, 0, 0}, 1, 0, true},
    {"Hz", {0, 0, -1, 0, 0, 0}, 1, 0, true},
    {"rad", {0, 0, 0, 1, 0, 0}, 1, 0, true},
    {"deg", {0, 0, 0, 1, 0, 0}, kPi / 180, 0, false},
    {"rev", {0, 0, 0, 1, 0, 0}, 2 * kPi, 0, false},
    {"rpm", {0, 0, -1, 1, 0, 0}, kPi / 30, 0, false},
    {"l", {3, 0, 0, 0, 0, 0}, 1, -3, true},
    {"t", {0, 1, 0, 0, 0, 0}, 1, 3, false},
    {"K", {0, 0, 0, 0, 1, 0}, 1, 0, true},
    {"%", {}, 1, -2, false},
    {"%critical", {0, 0, 0, 0, 0, 1}, 1, -2, false},
};

constexpr std::pair<std::string_view, int> kPrefixes[] = {{"T", 12}, {"G", 9},  {"M", 6},  {"k", 3},  {"h", 2},  {"d", -1},
                                                          {"c", -2}, {"m", -3}, {"µ", -6}, {"μ", -6}, {"u", -6}, {"n", -9}};

/// One symbol with its prefix, power one. Throws when unknown.
Unit find_symbol(std::string_view word) {
  for (const Symbol& s : kSymbols) {
    if (word == s.name) return {s.dimension, s.factor, s.decade};
  }
  for (const auto& [prefix, decade] : kPrefixes) {
    if (word.substr(0, prefix.size()) != prefix) continue;
    for (const Symbol& s : kSymbols) {
      if (s.prefixable && word.substr(prefix.size()) == s.name) return {s.dimension, s.factor, s.decade + decade};
    }
  }
  throw std::invalid_argument(fmt::format("unknown unit '{}'", word));
}

void multiply(Unit& product, const Unit& unit, int power) {
  for (std::size_t i = 0; i < product.dimension.size(); ++i) product.dimension[i] += power * unit.dimension[i];
  for (int n = 0; n < std::abs(power); ++n) product.factor = power > 0 ? product.factor * unit.factor : product.factor / unit.factor;
  product.decade += power * unit.decade;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

bool is_power(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+'; }

/// Splits "m^-3" or "m3" into symbol and power.
std::pair<std::string_view, int> split_power(std::string_view term) {
  std::size_t end = term.size();
  while (end > 0 && is_power(term[end - 1])) --end;
  if (end == 0) throw std::invalid_argument(fmt::format("unknown unit '{}'", term));
  const bool caret = term[end - 1] == '^';
  const std::string digits(term.substr(end));
  const std::string_view symbol = term.substr(0, caret ? end - 1 : end);
  if (digits.empty() && !caret) return {symbol, 1};
  const std::size_t sign = digits.empty() || digits[0] == '-' || digits[0] == '+' ? 1 : 0;
  const bool number = digits.size() == sign + 1 && is_power(digits[sign]) && digits[sign] > '0' && digits[sign] <= '9';
  if (!number) throw std::invalid_argument(fmt::format("the power of '{}' is not a whole number from -9 to 9", term));
  return {symbol, std::stoi(digits)};
}

std::string composed_name(const Dimension& d) {
  static constexpr const char* base[] = {"m", "kg", "s", "rad", "K", "%critical"};
  std::string text;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (d[i] == 0) continue;
    if (!text.empty()) text += ' ';
    text += base[i];
    if (d[i] != 1) text += fmt::format("^{}", d[i]);
  }
  return fmt::format("quantity in {}", text);
}

}  // namespace

double Unit::to_si(double number) const {
  const double scaled = number * factor;
  return decade < 0 ? scaled / std::pow(10.0, -decade) : scaled * std::pow(10.0, decade);
}

Unit parse_unit(std::string_view given) {
  std::string text = replaced(replaced(replaced(std::string(given), "²", "^2"), "³", "^3"), "·", "*");
  Unit unit;
  int sign = 1;
  std::size_t at = 0;
  bool wants_term = !text.empty();
  while (at < text.size() || wants_term) {
    at = text.find_first_not_of(' ', at);
    const std::size_t end = at == std::string::npos ? at : text.find_first_of(" */", at);
    const std::string_view term =
        at == std::string::npos ? "" : std::string_view(text).substr(at, end == std::string::npos ? end : end - at);
    if (term.empty()) throw std::invalid_argument(fmt::format("the unit '{}' is incomplete", given));
    if (term != "1") {
      const auto [symbol, power] = split_power(term);
      multiply(unit, find_symbol(symbol), sign * power);
    }
    const std::size_t joint = end == std::string::npos ? end : text.find_first_not_of(' ', end);
    if (joint == std::string::npos) break;
    sign = text[joint] == '/' ? -1 : 1;
    wants_term = text[joint] == '/' || text[joint] == '*';
    at = wants_term ? joint + 1 : joint;
  }
  return unit;
}

std::string dimension_name(const Dimension& dimension) {
  static constexpr std::pair<const char*, const char*> names[] = {{"1", "number without unit"},
                                                                  {"m", "length"},
                                                                  {"m^2", "area"},
                                                                  {"m^3", "volume"},
                                                                  {"kg", "mass"},
                                                                  {"s", "time"},
                                                                  {"m/s", "speed"},
                                                                  {"m/s^2", "acceleration"},
                                                                  {"rad", "angle"},
                                                                  {"rad/s", "angular speed"},
                                                                  {"1/s", "frequency"},
                                                                  {"N", "force"},
                                                                  {"N m", "torque or energy"},
                                                                  {"W", "power"},
                                                                  {"Pa", "pressure"},
                                                                  {"kg/m^3", "density"},
                                                                  {"N/m", "stiffness or surface tension"},
                                                                  {"kg/s", "damping"},
                                                                  {"Pa s", "viscosity"},
                                                                  {"K", "temperature"},
                                                                  {"%critical", "fraction of critical speed"},
                                                                  {"m^2/s", "kinematic viscosity"}};
  for (const auto& [unit, name] : names) {
    if (parse_unit(unit).dimension == dimension) return name;
  }
  return composed_name(dimension);
}

}  // namespace millscope::config
