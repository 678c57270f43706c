#include "kernel/config/units.hpp"

#include <numbers>

#include "tests/config/helpers.hpp"

using namespace millscope::config;
using testing::message_of;

namespace {

Node value_of(const std::string& text) { return parse_document("x: " + text + "\n", "a.yaml").at("x"); }
double number(const std::string& text, const char* unit) { return read_number(value_of(text), unit); }
std::string refusal_of(const std::string& text, const char* unit, const Range& range = any_number()) {
  return message_of([&] { read_number(value_of(text), unit, range); });
}

}  // namespace

TEST_CASE("decimal units are exact") {
  CHECK(number("5 mm", "m") == 0.005);
  CHECK(number("5mm", "m") == 0.005);
  CHECK(number("0.3", "m") == 0.3);
  CHECK(number("+1e-3", "m") == 0.001);
  CHECK(number(".5 um", "m") == 0.5e-6);
  CHECK(number("7 µm", "m") == 7e-6);
  CHECK(number("31.3 %", "1") == 0.313);
  CHECK(number("26 GPa", "Pa") == 26e9);
  CHECK(number("2500 kg/m^3", "kg/m^3") == 2500);
  CHECK(number("2500 kg/m3", "kg/m^3") == 2500);
  CHECK(number("2.5 g/cm^3", "kg/m^3") == 2500);
  CHECK(number("2.5 g/cm³", "kg/m^3") == 2500);
  CHECK(number("2.5 t/m^3", "kg/m^3") == 2500);
  CHECK(number("10 ms", "s") == 0.01);
  CHECK(number("2 min", "s") == 120);
  CHECK(number("1 h", "s") == 3600);
  CHECK(number("3 g", "kg") == 0.003);
  CHECK(number("1 mPa s", "Pa s") == 0.001);
  CHECK(number("1 mPa*s", "Pa s") == 0.001);
  CHECK(number("50 mJ/m^2", "J/m^2") == 0.05);
  CHECK(number("0.3 N/m", "N/m") == 0.3);
  CHECK(number("0.3 N/m", "J/m^2") == 0.3);
  CHECK(number("3 kN m", "N m") == 3000);
  CHECK(number("3 N·m", "J") == 3);
  CHECK(number("2 s^-1", "1/s") == 2);
  CHECK(number("2 kHz", "1/s") == 2000);
  CHECK(number("2 1/s", "1/s") == 2);
  CHECK(number("2 kg/s", "kg/s") == 2);
  CHECK(number("2 l", "m^3") == 0.002);
  CHECK(number("2 m/s/s", "m/s^2") == 2);
}

TEST_CASE("angles") {
  using std::numbers::pi;
  CHECK(number("60 deg", "rad") == Approx(pi / 3).epsilon(1e-15));
  CHECK(number("30 rpm", "rad/s") == Approx(pi).epsilon(1e-15));
  CHECK(number("1 rev/s", "rad/s") == Approx(2 * pi).epsilon(1e-15));
  CHECK(number("5 rad/s", "rad/s") == 5);
  const Quantity critical = read_quantity(value_of("75 %critical"));
  CHECK(critical.unit.to_si(critical.number) == 0.75);
  CHECK(dimension_name(critical.unit.dimension) == "fraction of critical speed");
}

TEST_CASE("wrong units and numbers are refused") {
  CHECK(refusal_of("5 mm", "s") == "a.yaml:1: 'x' is '5 mm' (length); expected: time in s");
  CHECK(refusal_of("5 Hz", "rad/s") == "a.yaml:1: 'x' is '5 Hz' (frequency); expected: angular speed in rad/s, e.g. 6 rad/s or 58 rpm");
  CHECK(refusal_of("5 mm", "1") == "a.yaml:1: 'x' is '5 mm' (length); expected: number without unit such as 0.5 or 50 %");
  CHECK(refusal_of("5 kg^2 m", "m").find("(quantity in m kg^2);") != std::string::npos);
  CHECK(refusal_of("5 furlong", "m") == "a.yaml:1: 'x' is '5 furlong': unknown unit 'furlong'");
  CHECK(refusal_of("5 m/", "m") == "a.yaml:1: 'x' is '5 m/': the unit 'm/' is incomplete");
  CHECK(refusal_of("5 m^x", "m") == "a.yaml:1: 'x' is '5 m^x': unknown unit 'm^x'");
  CHECK(refusal_of("5 m^33", "m") == "a.yaml:1: 'x' is '5 m^33': the power of 'm^33' is not a whole number from -9 to 9");
  CHECK(refusal_of("mm", "m") == "a.yaml:1: 'x' is 'mm'; a number is expected, bare (SI) or with a unit such as '5 mm'");
  CHECK(refusal_of("nan", "m") == "a.yaml:1: 'x' is 'nan'; a number is expected, bare (SI) or with a unit such as '5 mm'");
  CHECK(refusal_of("inf", "m").find("a.yaml:1: 'x' is 'inf'; a number is expected") == 0);
  CHECK(refusal_of("1e999", "m") == "a.yaml:1: 'x' is '1e999', which no double holds");
  CHECK(refusal_of("0,5", "m") == "a.yaml:1: 'x' is '0,5'; write the number with a decimal point and no separators");
  CHECK(refusal_of("1_000", "m") == "a.yaml:1: 'x' is '1_000'; write the number with a decimal point and no separators");
  CHECK(refusal_of("'010'", "m") == "a.yaml:1: 'x' is '010'; write it without the leading 0");
  CHECK(refusal_of("{a: 1}", "m") == "a.yaml:1: 'x' is a map; a single value is expected");
}

TEST_CASE("ranges say their reason") {
  CHECK(refusal_of("-1 mm", "m", positive("it is a size")) == "a.yaml:1: 'x' is -0.001 m; it must be above 0 m; it is a size");
  CHECK(refusal_of("-1", "s", not_negative()) == "a.yaml:1: 'x' is -1 s; it must be at least 0 s");
  CHECK(refusal_of("150 %", "1", between(0, 1)) == "a.yaml:1: 'x' is 1.5; it must be from 0 to 1");
  CHECK(refusal_of("0.5", "1", {-1, 0.5, true, true, ""}) == "a.yaml:1: 'x' is 0.5; it must be above -1 and below 0.5");
  CHECK(refusal_of("1", "1", {0, 1, false, true, ""}) == "a.yaml:1: 'x' is 1; it must be at least 0 and below 1");
  CHECK(refusal_of("0", "1", {0, 1, true, false, ""}) == "a.yaml:1: 'x' is 0; it must be above 0 and at most 1");
}

TEST_CASE("integers, flags, choices and vectors") {
  CHECK(read_integer(value_of("1e3"), any_number()) == 1000);
  CHECK(message_of([] { read_integer(value_of("1.5"), any_number()); }) == "a.yaml:1: 'x' is '1.5'; a whole number is expected");
  CHECK(message_of([] { read_integer(value_of("1 mm"), any_number()); }) ==
        "a.yaml:1: 'x' is '1 mm'; a whole number without unit is expected");
  CHECK(read_flag(value_of("true")));
  CHECK(message_of([] { read_flag(value_of("yes")); }) == "a.yaml:1: 'x' is 'yes'; write true or false");
  CHECK(read_choice(value_of("mass"), "mass|number") == "mass");
  CHECK(message_of([] { read_choice(value_of("mas"), "mass|number"); }) ==
        "a.yaml:1: 'x' is 'mas'; it must be one of mass, number; did you mean 'mass'?");
  CHECK(read_vector(value_of("[0, 5 mm, 0.2]"), "m") == std::array<double, 3>{0, 0.005, 0.2});
  CHECK(read_vector(value_of("[0, 5, 20, mm]"), "m") == std::array<double, 3>{0, 0.005, 0.02});
  CHECK(message_of([] { read_vector(value_of("[1, 2]"), "m"); }) == "a.yaml:1: 'x' has 2 components; write [x, y, z]");
  CHECK(message_of([] { read_vector(value_of("[1 mm, 2, 3, mm]"), "m"); }) ==
        "a.yaml:1: 'x.0' has a unit and the vector ends with one; keep one of them");
}

TEST_CASE("number texts read back to the same double") {
  for (const double value : {0.1, 1.0 / 3, 2500.0, 6.1167, 1e-300, -0.005, 26e9, 63.96e9, 1e22}) {
    CHECK(number(number_text(value), "1") == value);
  }
  CHECK(number_text(2500) == "2500");
  CHECK(number_text(-0.0) == "0");
}
