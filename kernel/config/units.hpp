// Numbers with units. A bare number is SI; `5 mm`, `58.4 rpm`, `75 %critical`, `2500 kg/m^3`, `0.3 N/m`, `1 mPa s` carry theirs.
//
// A unit is built from symbols, each with an optional prefix (T G M k h d c m u µ n) and a power (`m^3`, `m3`, `m³`, `s^-1`), joined by
// '/', '*', '·' or a space; '/' binds to the next symbol alone. Symbols: m g s min h N Pa bar J W Hz rad deg rev rpm l t K % %critical.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "kernel/config/document.hpp"

namespace millscope::config {

/// Powers of m, kg, s, rad, K and of "fraction of critical speed".
using Dimension = std::array<int, 6>;

/// A unit: SI value = number · factor · 10^decade. The decade apart keeps `5 mm` equal to 0.005 to the bit.
struct Unit {
  Dimension dimension{};
  double factor = 1;
  int decade = 0;

  double to_si(double number) const;
};

/// Parses "kg/m^3"; "" and "1" are dimensionless. Throws std::invalid_argument naming the symbol that is unknown.
Unit parse_unit(std::string_view text);

/// "length", "angular speed", … or the composed SI unit when it has no name here.
std::string dimension_name(const Dimension& dimension);

/// A number and the unit behind it, still apart.
struct Quantity {
  double number = 0;
  bool has_unit = false;
  Unit unit;
};

/// Splits and parses "5 mm". Throws UserError at the node for anything that is not a finite decimal number with a known unit.
Quantity read_quantity(const Node& node);

/// Allowed values, both ends included unless open.
struct Range {
  double low;
  double high;
  bool open_low = false;
  bool open_high = false;
  const char* reason = "";  ///< why, said in the message
};
Range any_number();
Range positive(const char* reason = "");
Range not_negative(const char* reason = "");
Range between(double low, double high, const char* reason = "");

/// A number in the SI unit given ("m", "rad/s", "1", …). Throws UserError for a wrong kind of unit and outside the range.
double read_number(const Node& node, std::string_view si_unit, const Range& range = any_number());
/// Checks a value that was read or computed.
void check_range(const Node& node, double value, std::string_view si_unit, const Range& range);
/// A whole number without unit.
long long read_integer(const Node& node, const Range& range);
/// `true` or `false`, nothing else.
bool read_flag(const Node& node);
/// One of "a|b|c".
std::string read_choice(const Node& node, std::string_view choices);
/// Three components: `[x, y, z]` with a unit each, or bare with one unit as a fourth item: `[0, 0, 20, mm]`.
std::array<double, 3> read_vector(const Node& node, std::string_view si_unit, const Range& range = any_number());

/// A number as shortest text that reads back to the same double.
std::string number_text(double value);

}  // namespace millscope::config
