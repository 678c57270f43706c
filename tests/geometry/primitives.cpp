#include <catch2/catch.hpp>

#include <cmath>

#include "geometry/shapes/box.hpp"
#include "geometry/shapes/mill.hpp"
#include "geometry/shapes/plane.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

Given box_values(const char* open) {
  Given g;
  g.number("low", 0, 0, 0).number("high", 0.1, 0.2, 0.3).text("open", open);
  return g;
}

template <class Wall>
std::string refusal(const Given& given) {
  try {
    Wall wall(given.parameters());
  } catch (const Refusal& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("plane") {
  Given g;
  g.number("point", 0, 1, 0).number("normal", 0, 3, 0).number("size", 1).number("round", 0);
  Plane plane(g.parameters());
  const WallContacts found = touch(plane, {5, 1.004, -7}, 0.005);
  REQUIRE(found.count() == 1);
  CHECK_THAT(found[0].overlap, WithinAbs(0.001, 1e-15));
  CHECK_THAT(found[0].normal.y, WithinAbs(1, 1e-15));
  CHECK(touch(plane, {5, 1.006, 0}, 0.005).count() == 0);
  CHECK(touch(plane, {5, 1.006, 0}, 0.005, 0.002).count() == 1);
  const auto mesh = make_mesh(soup_of(plane.surface(), {"all"}));
  CHECK(double_area(mesh->mesh(), 0).y > 0);
  CHECK_THAT(mesh->survey().area, WithinAbs(1, 1e-12));
  Given disc;
  disc.number("point", 0, 1, 0).number("normal", 0, 3, 0).number("size", 1).number("round", 1);
  const auto drawn = make_mesh(soup_of(Plane(disc.parameters()).surface(), {"all"}));
  CHECK_THAT(drawn->survey().area, WithinAbs(0.7854, 2e-3));
  CHECK(double_area(drawn->mesh(), 0).y > 0);
  Given flat;
  flat.number("point", 0).number("normal", 0, 0, 0).number("size", 1).number("round", 0);
  CHECK_THAT(refusal<Plane>(flat), Contains("no direction"));
}

TEST_CASE("box: faces, edges, corners, open rims") {
  Box closed(box_values("").parameters());
  CHECK(closed.material_slots() == "x_low|x_high|y_low|y_high|z_low|z_high");
  CHECK(touch(closed, {0.05, 0.1, 0.0049}, 0.005).count() == 1);
  CHECK(touch(closed, {0.0049, 0.1, 0.0049}, 0.005).count() == 2);
  CHECK(touch(closed, {0.0049, 0.0049, 0.0049}, 0.005).count() == 3);
  CHECK_THAT(touch(closed, {-0.001, 0.1, 0.1}, 0.005)[0].overlap, WithinAbs(0.006, 1e-15));

  Box open(box_values("+y").parameters());
  CHECK(open.material_slots() == "x_low|x_high|y_low|z_low|z_high");
  CHECK(touch(open, {0.05, 0.199, 0.15}, 0.005).count() == 0);
  const double s = 0.0049 / std::sqrt(2.0);
  const WallContacts rim = touch(open, {s, 0.2 + s, 0.15}, 0.005);
  REQUIRE(rim.count() == 1);
  CHECK_THAT(rim[0].overlap, WithinAbs(1e-4, 1e-12));
  CHECK_THAT(rim[0].normal.y, WithinAbs(std::sqrt(0.5), 1e-12));

  CHECK_THAT(refusal<Box>(box_values("up")), Contains("'up'"));
  CHECK_THAT(refusal<Box>(box_values("-x +x -y +y -z +z")), Contains("all six"));
  Given thin;
  thin.number("low", 0, 0, 0).number("high", 0.1, 0, 0.3).text("open", "");
  CHECK_THAT(refusal<Box>(thin), Contains("along y"));
}

TEST_CASE("box: the triangles face inwards and are watertight") {
  Box closed(box_values("").parameters());
  const auto mesh = make_mesh(soup_of(closed.surface(), {"a", "b", "c", "d", "e", "f"}));
  CHECK(mesh->topology().open_edges == 0);
  CHECK_THAT(mesh->survey().volume, WithinAbs(-0.006, 1e-12));
}

TEST_CASE("cylinder") {
  Given g;
  g.number("radius", 0.15).number("length", 0.02).number("end_faces", 1).number("facet", 0.003).number("axial_cuts", 1);
  CylinderPlugin cylinder(g.parameters());
  CHECK(cylinder.material_slots() == "shell|end");
  CHECK(touch(cylinder, {0, 0.1476, 0.01}, 0.0025).count() == 1);
  CHECK(touch(cylinder, {0, 0.1476, 0.002}, 0.0025).count() == 2);
  CHECK(touch(cylinder, {0, 0, 0.01}, 0.0025).count() == 0);
  CHECK_THAT(touch(cylinder, {0, -0.148, 0.01}, 0.0025)[0].normal.y, WithinAbs(1, 1e-15));
  CHECK(touch(cylinder, {0, 0, 0.01}, 0.2).count() == 3);
}
