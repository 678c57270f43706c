#include <catch2/catch.hpp>

#include <numbers>

#include "geometry/shapes/mill.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("The report of a cube") {
  const auto mesh = make_mesh(cube(0.1));
  const std::string& text = mesh->report();
  CHECK_THAT(text, Contains("triangles: 12\nvertices: 8\n"));
  CHECK_THAT(text, Contains("box: [0, 0, 0] to [0.1, 0.1, 0.1] m"));
  CHECK_THAT(text, Contains("area: 0.06 m^2"));
  CHECK_THAT(text, Contains("surface: closed, volume 0.001 m^3"));
  CHECK_THAT(text, Contains("open edges: 0\n"));
  CHECK_THAT(text, Contains("degenerate triangles: 0 dropped\nduplicate triangles: 0 dropped\n"));
  CHECK_THAT(text, Contains("orientation: facing outwards"));
  CHECK_THAT(text, Contains("solids: 1 (all)"));
  CHECK_THAT(text, Contains("smooth patches: 6"));
  CHECK_THAT(text, Contains("axis: none found"));
  CHECK_FALSE(mesh->interior().is_cylinder);
}

TEST_CASE("Faults of a mesh are counted") {
  Soup soup = cube(0.1);
  add_triangle(soup, soup.corners[3], soup.corners[4], soup.corners[5]);  // again
  add_triangle(soup, {0, 0, 0}, {0.1, 0, 0}, {0.05, 0, 0});               // no area
  add_triangle(soup, {0, 0, 0}, {0, 0, 0}, {0.05, 0, 0});                 // two equal corners
  SECTION("closed in spite of them") {
    const auto mesh = make_mesh(soup);
    CHECK(mesh->mesh().own == 12);
    CHECK_THAT(mesh->report(), Contains("degenerate triangles: 2 dropped\nduplicate triangles: 1 dropped\n"));
  }
  SECTION("a hole") {
    soup.corners.erase(soup.corners.begin(), soup.corners.begin() + 3);
    soup.slots.pop_back();
    CHECK_THAT(make_mesh(soup)->report(), Contains("open edges: 3\n"));
  }
  SECTION("a triangle turned over") {
    std::swap(soup.corners[0], soup.corners[1]);
    CHECK_THAT(make_mesh(soup)->report(), Contains("orientation: mixed"));
  }
  SECTION("a fin on an edge") {
    add_triangle(soup, {0, 0, 0}, {0.1, 0, 0}, {0.05, -0.05, -0.05});
    CHECK_THAT(make_mesh(soup)->report(), Contains("edges of three or more triangles: 1\n"));
  }
}

TEST_CASE("The report of a mill: axis, orientation, solids, interior") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.27, shape.lifters = 20, shape.lifter_height = 0.005, shape.lifter_width = 0.02;
  shape.face_angle = std::numbers::pi / 3, shape.end_faces = GENERATE(true, false);
  const Mill mill("mill", shape, 0.003, 1);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter", "end"}));
  CHECK_THAT(mesh->report(), Contains("axis: z through [0, 0, 0.135] m"));
  CHECK_THAT(mesh->report(), Contains("orientation: facing inwards"));
  CHECK_THAT(mesh->report(), Contains(shape.end_faces ? "surface: closed" : "surface: open"));
  REQUIRE(mesh->interior().is_cylinder);
  CHECK_THAT(mesh->interior().radius, WithinRel(0.15, 1e-9));
  CHECK_THAT(mesh->interior().high[2], WithinAbs(0.27, 1e-12));
  if (shape.end_faces) {
    const double volume = std::numbers::pi * 0.15 * 0.15 * 0.27;
    CHECK_THAT(mesh->survey().volume, WithinRel(-volume, 0.05));
  }
}

TEST_CASE("The bare shell of a thick liner is its inner surface") {
  Soup soup = empty_soup();
  const int n = 90;
  for (const double radius : {0.15, 0.18}) {
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int k, double z) {
        return Point{radius * std::cos(2 * std::numbers::pi * k / n), radius * std::sin(2 * std::numbers::pi * k / n), z};
      };
      add_quad(soup, at(i, 0), at(i + 1, 0), at(i + 1, 0.1), at(i, 0.1));
    }
  }
  CHECK_THAT(make_mesh(soup)->interior().radius, WithinRel(0.15, 1e-3));
}
