// Units, ticks and colours: what a reader takes from a picture.
#include <catch2/catch.hpp>
#include <cmath>

#include "raster.hpp"
#include "studies/picture/color.hpp"
#include "studies/picture/scale.hpp"

using namespace millscope;

TEST_CASE("units are shown with the prefix that an engineer expects") {
  const auto shown = [](const char* unit, double largest) {
    const picture::DisplayUnit d = picture::display_unit(unit, largest);
    return std::pair(d.text, d.factor * largest);
  };
  const auto check = [&](const char* unit, double largest, const char* text, double value) {
    const auto [found, number] = shown(unit, largest);
    CAPTURE(unit, largest);
    CHECK(found == text);
    CHECK(number == Approx(value));
  };
  check("m", 0.15, "mm", 150);
  check("m", 230, "m", 230);  // a wrong unit must look wrong
  check("W", 0.0021, "mW", 2.1);
  check("W", 7.3, "W", 7.3);
  check("W", 29500, "kW", 29.5);
  check("J", 2e-5, "µJ", 20);
  check("m/s", 2.4, "m/s", 2.4);
  check("m/s", 0.02, "mm/s", 20);
  check("1", 0.0042, "%", 0.42);
  check("1", 1.0, "", 1.0);
  check("rad/s", 6.1, "rad/s", 6.1);
  check("m^2/s^2", 0.004, "10⁻³ m²/s²", 4);
  check("kg/m^3", 1575, "kg/m³", 1575);
  check("1/s", 2.5e6, "10⁶ 1/s", 2.5);
  check("rad", 0.5, "°", 28.6478897565);
}

TEST_CASE("ticks are multiples of 1, 2 or 5 and never too many") {
  for (const double low : {-0.2, 0.0, 3.7, -1234.0}) {
    for (const double span : {1e-6, 0.3, 0.7, 1.0, 47.0, 1e5}) {
      const double high = low + span;
      const picture::Ticks ticks = picture::even_ticks(low, high, 7);
      CAPTURE(low, span);
      REQUIRE(ticks.major.size() >= 2);
      REQUIRE(ticks.major.size() <= 8);
      REQUIRE(ticks.label.size() == ticks.major.size());
      const double step = ticks.major[1] - ticks.major[0], digit = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
      CHECK((std::abs(digit - 1) < 1e-3 || std::abs(digit - 2) < 1e-3 || std::abs(digit - 5) < 1e-3));
      CHECK(ticks.major.front() >= low - 1e-6 * span);
      CHECK(ticks.major.back() <= high + 1e-6 * span);
      CHECK(std::adjacent_find(ticks.label.begin(), ticks.label.end()) == ticks.label.end());  // labels tell ticks apart
    }
  }
  CHECK(picture::even_ticks(3.77, 3.77 + 4e-16, 5).major.empty());  // a map that is constant but for rounding: this loop had no end
  CHECK(picture::even_ticks(-1, 1, 5).label == std::vector<std::string>{"−1.0", "−0.5", "0.0", "0.5", "1.0"});
}

TEST_CASE("logarithmic axes are labelled at decades, and between them where there are few") {
  CHECK(picture::logarithmic_ticks(1e-9, 1e-1, 10).label.front() == "10⁻⁹");
  CHECK(picture::logarithmic_ticks(1, 100, 8).label == std::vector<std::string>{"1", "2", "5", "10", "20", "50", "100"});
  const picture::Axis axis = picture::make_axis("energy", "J", 1e-6, 1e-2, true, 360);
  CHECK(axis.place(1e-4) == Approx(0.5));
  CHECK(std::isnan(axis.place(0)));
}

TEST_CASE("numbers have a true minus and no false digits") {
  CHECK(picture::number_text(-0.25, 0.05) == "−0.25");
  CHECK(picture::number_text(1e-17, 0.1) == "0.0");
  CHECK(picture::number_text(2000, 500) == "2000");
  CHECK(picture::significant_text(0.0123456, 3) == "0.0123");
  CHECK(picture::significant_text(-7334.6, 3) == "−7335");
  CHECK(picture::significant_text(std::nan(""), 3) == "–");
}

TEST_CASE("colours order by lightness, so that grey print and colour-blind eyes read them too") {
  double last = -1;
  for (int i = 0; i <= 64; ++i) {
    const double light = picture_test::lightness(picture::sequential_color(i / 64.0));
    CHECK(light > last);
    last = light;
  }
  for (int i = 0; i < 32; ++i) {  // both arms rise to the middle, alike
    const double cool = picture_test::lightness(picture::diverging_color(i / 64.0)),
                 warm = picture_test::lightness(picture::diverging_color(1 - i / 64.0));
    CHECK(cool < picture_test::lightness(picture::diverging_color((i + 1) / 64.0)));
    CHECK(std::abs(cool - warm) < 6);
  }
}
