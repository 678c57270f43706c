// Pictures of results: which are drawn, how axes become edges, the cut through the mill.
#include "studies/picture/results_pictures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "host/temporary.hpp"
#include "raster.hpp"
#include "studies/picture/outline.hpp"

using namespace millscope;
using host_test::refusal;

namespace {

analysis::ResultArray array_of(const char* name, const char* unit, std::vector<std::size_t> shape, std::vector<std::string> axes,
                               std::vector<double> value) {
  analysis::ResultArray array;
  array.analyzer = "fields", array.name = name, array.unit = unit, array.doc = "Test.";
  array.shape = std::move(shape), array.axes = std::move(axes), array.value = std::move(value);
  return array;
}

analysis::ResultSet example() {
  analysis::ResultSet set;
  set.meta.name = "test", set.meta.source = "recording";
  set.meta.blocks = {{0, 10, 9.5, 0}, {10, 20, 10, 0}};
  set.meta.context.mill_radius = 0.1, set.meta.context.omega = 5;
  set.arrays = {array_of("x_edges", "m", {3}, {}, {-0.1, 0, 0.1}), array_of("y_edges", "m", {3}, {}, {-0.1, 0, 0.1}),
                array_of("centres", "s", {3}, {}, {1, 2, 4}), array_of("power", "W", {}, {}, {7})};
  for (analysis::ResultArray& a : set.arrays) a.is_axis = a.name != "power";
  set.arrays.push_back(array_of("speed", "m/s", {2, 2}, {"y_edges", "x_edges"}, {1, 2, 3, 4}));
  set.arrays.push_back(array_of("decay", "1", {3}, {"centres"}, {1, 0.5, 0.2}));
  set.arrays.push_back(array_of("parts", "1", {3}, {""}, {1, 0.5, 0.2}));
  set.arrays.push_back(array_of("box", "1", {2, 1, 2}, {"", "", ""}, {1, 2, 3, 4}));
  set.arrays.push_back(array_of("nothing", "1", {3}, {"centres"}, std::vector<double>(3, std::numeric_limits<double>::quiet_NaN())));
  return set;
}

}  // namespace

TEST_CASE("every curve and map is drawn, and what is not is told") {
  const host_test::Temporary folder;
  const analysis::ResultSet set = example();
  const picture::DrawnPictures drawn = picture::draw_results(set, folder.path() / "pictures", picture::shell_of(set));
  CHECK(drawn.files.size() == 3);
  CHECK(drawn.left_out == std::vector<std::string>{"fields.box: 3 dimensions; see the tables", "fields.nothing: no value is defined"});
  for (const auto& stem : drawn.files) {
    CHECK(std::filesystem::exists(stem.string() + ".svg"));
    CHECK(picture_test::read_png(stem.string() + ".png").has_white_margin(4));
  }
  // The upper right cell is the fastest: rows go with y, columns with x.
  const picture_test::Raster speed = picture_test::read_png(folder.path() / "pictures" / "fields.speed.png");
  const auto slow = speed.find(picture_test::to_pixel(picture::sequential_color(0.25))),
             quick = speed.find(picture_test::to_pixel(picture::sequential_color(0.75)));
  CHECK(slow.x < quick.x + 20);  // 1 m/s lower left, 3 m/s upper left
  CHECK(slow.y > quick.y + 200);
}

TEST_CASE("axes are edges, or centres that become edges, or a count") {
  analysis::ResultSet set = example();
  CHECK(picture::cell_axis(set, set.arrays[4], 1).edges == std::vector<double>{-0.1, 0, 0.1});
  CHECK(picture::cell_axis(set, set.arrays[4], 1).label == "x");
  CHECK(picture::cell_axis(set, set.arrays[5], 0).edges == std::vector<double>{0.5, 1.5, 3, 5});
  CHECK(picture::cell_axis(set, set.arrays[6], 0).edges == std::vector<double>{0.5, 1.5, 2.5, 3.5});
  set.arrays[2].value.push_back(8), set.arrays[2].value.push_back(16);
  CHECK(refusal([&] { picture::cell_axis(set, set.arrays[5], 0); }).find("fields.decay: its axis 'centres' has 5 values for 3 cells") == 0);
}

TEST_CASE("a description that counts names makes a map of names") {
  analysis::ResultArray kind = array_of("region", "1", {1, 3}, {"", ""}, {0, 1, 2});
  kind.doc = "0 nothing, 1 en masse, 2 cascading layer.";
  CHECK(picture::category_names(kind) == std::vector<std::string>{"nothing", "en masse", "cascading layer"});
  kind.doc = "Share of 3 regions, 1 for each.";
  CHECK(picture::category_names(kind).empty());
}

TEST_CASE("the line below the title says what was analysed") {
  CHECK(picture::source_line(example().meta) == "test · recording · 19.5 s analysed");
  CHECK(picture::title_of("velocity_x") == "Velocity x");
}

TEST_CASE("the cut through a lifter is its outline, without the shell") {
  // A box from x = 0.08 to 0.1 and y = −0.01 to 0.01, open at its ends, 1 m long: sides of two triangles each; one side lies on the shell.
  const double corner[4][2] = {{0.08, -0.01}, {0.1, -0.01}, {0.1, 0.01}, {0.08, 0.01}};
  std::vector<double> vertices;
  for (const double z : {0.0, 1.0}) {
    for (const auto& c : corner) vertices.insert(vertices.end(), {c[0], c[1], z});
  }
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    triangles.insert(triangles.end(), {i, j, j + 4, i, j + 4, i + 4});
  }
  const millscope::Surface surface{8, vertices.data(), 8, triangles.data(), nullptr};
  double length = 0;
  for (const auto& l : picture::section_of(surface, 0.3, 0.1)) length += std::hypot(l[2] - l[0], l[3] - l[1]);
  CHECK(length == Approx(0.02 + 0.02 + 0.02));
  CHECK(picture::section_of(surface, 2, 0.1).empty());
}
