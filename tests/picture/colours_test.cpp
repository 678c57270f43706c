// colours.json holds pictures and page to the same colours: here the pictures, in tests/report the page.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "studies/picture/map_colors.hpp"

using namespace millscope;
using nlohmann::json;

namespace {

json agreed() { return json::parse(std::ifstream(std::string(MILLSCOPE_SOURCE_DIR) + "/tests/picture/colours.json")); }

void check_color(const picture::Color& color, const json& rgb) {
  CAPTURE(rgb);
  CHECK(255 * color.red == Approx(rgb.at(0).get<double>()).margin(0.51));
  CHECK(255 * color.green == Approx(rgb.at(1).get<double>()).margin(0.51));
  CHECK(255 * color.blue == Approx(rgb.at(2).get<double>()).margin(0.51));
}

}  // namespace

TEST_CASE("the pictures have the agreed colours") {
  const json colours = agreed();
  for (const json& one : colours.at("sequential")) check_color(picture::sequential_color(one.at(0)), one.at(1));
  for (const json& one : colours.at("diverging")) check_color(picture::diverging_color(one.at(0)), one.at(1));
  for (std::size_t index = 0; index < colours.at("distinct").size(); ++index)
    check_color(picture::distinct_color(index), colours.at("distinct")[index]);
}

TEST_CASE("a map's scale ends where it is agreed to") {
  const json colours = agreed();
  for (const json& one : colours.at("scales")) {
    CAPTURE(one.at("what"));
    picture::MapPicture picture;
    picture.value.values = one.at("values").get<std::vector<double>>();
    const json& is_signed = one.at("signed");
    if (!is_signed.is_null()) picture.scale = is_signed.get<bool>() ? picture::ColorScale::diverging : picture::ColorScale::sequential;
    const picture::MapColors colors = picture::choose_colors(picture);
    CHECK(colors.diverging == one.at("diverging").get<bool>());
    CHECK(colors.low == Approx(one.at("low").get<double>()).margin(1e-12));
    CHECK(colors.high == Approx(one.at("high").get<double>()).margin(1e-12));
  }
}
