// Pictures as they come out, looked at pixel by pixel.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "host/temporary.hpp"
#include "kernel/base/text.hpp"
#include "raster.hpp"
#include "studies/picture/picture.hpp"

using millscope::base::text_of;
using namespace millscope;
using host_test::refusal;
using picture_test::Raster;
using picture_test::read_png;
using picture_test::to_pixel;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<double> edges(double low, double high, int cells) {
  std::vector<double> e;
  for (int i = 0; i <= cells; ++i) e.push_back(low + (high - low) * i / cells);
  return e;
}

/// 10 × 10 cells, all without data.
picture::MapPicture empty_map() {
  return {.title = "Speed",
          .subtitle = "test · 1.0 s analysed",
          .x = {"x", "m", edges(-0.1, 0.1, 10)},
          .y = {"y", "m", edges(-0.1, 0.1, 10)},
          .value = {"mean speed", "m/s", std::vector<double>(100, kNone)}};
}

picture::CurvePicture two_curves() {
  picture::Curve a{"a", edges(0, 1, 20), {}, {}, {}}, b = a;
  for (int i = 0; i < 20; ++i) {
    a.value.push_back(std::sin(i * 0.3)), b.value.push_back(std::cos(i * 0.3));
    a.low.push_back(a.value.back() - 0.2), a.high.push_back(a.value.back() + 0.2);
  }
  b.label = "b";
  return {
      .title = "Curves", .subtitle = "test", .x_label = "x", .x_unit = "m", .value_label = "value", .value_unit = "W", .curves = {a, b}};
}

}  // namespace

TEST_CASE("a cell lies where its axes say, with its colour, square, and cells without data have none") {
  const host_test::Temporary folder;
  picture::MapPicture map = empty_map();
  map.value.values[9 * 10 + 8] = 2;    // second column from the right, uppermost row
  map.value.values[0 * 10 + 0] = 0.8;  // lower left
  picture::draw_map(map, folder.path() / "map");
  const Raster raster = read_png(folder.path() / "map.png");
  const Raster::Spot low = raster.find(to_pixel(picture::sequential_color(0.4)));
  CHECK(low.count >= 60 * 60 - 300);  // the frame of the plot covers some
  // the bar, too, ends in the brightest colour: look at the plot alone
  Raster::Spot high;
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < low.left + 600; ++x) {
      if (raster.at(x, y) != to_pixel(picture::sequential_color(1))) continue;
      high.left = std::min(high.left, x), high.right = std::max(high.right, x), high.top = std::min(high.top, y),
      high.bottom = std::max(high.bottom, y);
    }
  }
  CHECK(high.right - high.left == Approx(59).margin(2));  // 10 cells on 300 points of 2 pixels
  CHECK(high.bottom - high.top == Approx(59).margin(2));
  CHECK(high.left - low.left == Approx(8 * 60).margin(2));
  CHECK(low.bottom - high.bottom == Approx(9 * 60).margin(2));
  // between them nothing is coloured: paper or grey hatching
  for (int y = high.bottom + 4; y < low.top - 4; ++y) {
    for (int x = low.right + 4; x < high.left - 4; ++x) {
      const std::uint32_t p = raster.at(x, y);
      REQUIRE((p >> 16) == (p & 255));
    }
  }
}

TEST_CASE("signed values are centred at zero, others start there") {
  const host_test::Temporary folder;
  picture::MapPicture map = empty_map();
  for (int i = 0; i < 100; ++i) map.value.values[i] = i < 50 ? -1 : 3;
  picture::draw_map(map, folder.path() / "signed");
  const Raster raster = read_png(folder.path() / "signed.png");
  CHECK(raster.find(to_pixel(picture::diverging_color((-1.0 + 3) / 6))).count > 600 * 290);
  CHECK(raster.find(to_pixel(picture::diverging_color(1))).count > 600 * 290);
  for (double& v : map.value.values) v = std::abs(v);
  picture::draw_map(map, folder.path() / "plain");
  CHECK(read_png(folder.path() / "plain.png").find(to_pixel(picture::sequential_color(1.0 / 3))).count > 600 * 290);
}

TEST_CASE("the arrow turns with the mill") {
  const host_test::Temporary folder;
  picture::MapPicture map = empty_map();
  map.mill = {.radius = 0.1, .omega = 3};
  picture::draw_map(map, folder.path() / "left");
  map.mill.omega = -3;
  picture::draw_map(map, folder.path() / "right");
  const Raster left = read_png(folder.path() / "left.png"), right = read_png(folder.path() / "right.png");
  // the middle of all pixels that differ lies at the heads: up and left of the other one for Ω > 0
  double moved_x = 0, moved_y = 0;
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      const double darker = static_cast<double>(right.at(x, y) & 255) - static_cast<double>(left.at(x, y) & 255);
      moved_x += darker * x, moved_y += darker * y;
    }
  }
  CHECK(moved_x < 0);
  CHECK(moved_y < 0);
}

TEST_CASE("the same arrays give the same bytes, whatever was drawn before") {
  const host_test::Temporary folder;
  picture::MapPicture map = empty_map();
  map.value.values[55] = 1;
  map.mill = {.radius = 0.1, .omega = 3};
  picture::draw_map(map, folder.path() / "one");
  picture::draw_curves(two_curves(), folder.path() / "curves");
  picture::draw_map(map, folder.path() / "two");
  CHECK(text_of(folder.path() / "one.svg") == text_of(folder.path() / "two.svg"));
  CHECK(text_of(folder.path() / "one.png") == text_of(folder.path() / "two.png"));
  CHECK(text_of(folder.path() / "one.svg").find("<title>Speed</title>") != std::string::npos);
}

TEST_CASE("nothing is cut off, however long the words and large the numbers") {
  const host_test::Temporary folder;
  const std::string tale =
      "a very long name of a source that goes on and on and does not fit on one line of any picture that one would print";
  picture::MapPicture map = empty_map();
  map.title = map.subtitle = map.note = tale;
  map.value = {"a quantity with a long name", "kg m^2/s^3", std::vector<double>(100, -123456.7)};
  map.value.values[0] = 9e9;
  map.marks = {{"somewhere near the edge", 0.099, 0.0}, {"lower left", -0.1, -0.1}};
  map.mill = {.radius = 0.1, .omega = 123};
  picture::draw_map(map, folder.path() / "map");
  CHECK(read_png(folder.path() / "map.png").has_white_margin(6));
  picture::CurvePicture curves = two_curves();
  curves.title = curves.subtitle = tale;
  for (int i = 0; i < 9; ++i) curves.curves.push_back({"source number " + std::to_string(i), edges(0, 1, 2), {-1e-7 * i, 4e8 * i}, {}, {}});
  picture::draw_curves(curves, folder.path() / "curves");
  CHECK(read_png(folder.path() / "curves.png").has_white_margin(6));
}

TEST_CASE("a curve without a value has a gap, not a zero") {
  const host_test::Temporary folder;
  picture::CurvePicture picture{.title = "t",
                                .subtitle = "s",
                                .x_label = "x",
                                .x_unit = "m",
                                .value_label = "v",
                                .value_unit = "W",
                                .curves = {{"only", edges(0, 1, 10), std::vector<double>(10, 1.0), {}, {}}}};
  const auto blue = [&](const char* name) {
    picture::draw_curves(picture, folder.path() / name);
    return read_png(folder.path() / (std::string(name) + ".png")).find(to_pixel(picture::distinct_color(0)));
  };
  const Raster::Spot whole = blue("whole");
  for (int i = 3; i < 7; ++i) picture.curves[0].value[i] = kNone;
  const Raster::Spot broken = blue("broken");
  CHECK(broken.count < 0.7 * whole.count);
  CHECK(broken.bottom == whole.bottom);
}

TEST_CASE("pictures that cannot be are refused in one line") {
  const host_test::Temporary folder;
  picture::MapPicture map = empty_map();
  map.value.values.pop_back();
  CHECK(refusal([&] { picture::draw_map(map, folder.path() / "m"); }) ==
        "picture 'Speed': 99 values for 100 cells; check the axes of this result");
  map = empty_map();
  std::swap(map.x.edges[2], map.x.edges[3]);
  CHECK(refusal([&] { picture::draw_map(map, folder.path() / "m"); }).find("do not increase") != std::string::npos);
  picture::CurvePicture curves = two_curves();
  curves.curves[0].x.pop_back(), curves.curves[0].x.pop_back();
  CHECK(refusal([&] { picture::draw_curves(curves, folder.path() / "c"); }).find("20 values on an axis of 19") != std::string::npos);
  CHECK(refusal([&] { picture::draw_curves(two_curves(), folder.path() / "missing" / "c"); }).find("missing") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a map without any data is drawn and says so") {
  const host_test::Temporary folder;
  picture::draw_map(empty_map(), folder.path() / "empty");
  CHECK(std::filesystem::exists(folder.path() / "empty.png"));
}
