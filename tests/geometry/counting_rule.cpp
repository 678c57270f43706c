#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "geometry/shapes/mill.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::WithinAbs;

TEST_CASE("A tessellated plane touches once, everywhere") {
  const auto plane = make_mesh(sheet(0.1, 10));
  const double r = 0.005, overlap = 1e-4;
  for (int i = 10; i <= 90; ++i) {
    for (int j = 10; j <= 90; j += 5) {  // over faces, edges, diagonals and vertices alike
      const WallContacts found = touch(*plane, {i * 1e-3, j * 1e-3, r - overlap}, r);
      REQUIRE(found.count() == 1);
      REQUIRE_THAT(found[0].overlap, WithinAbs(overlap, 1e-15));
      REQUIRE_THAT(found[0].normal.z, WithinAbs(1, 1e-12));
      REQUIRE(found[0].feature == 0);
    }
  }
}

TEST_CASE("A plane of triangles that share no vertices touches once") {  // T-junctions: halves of different size on both sides of x = 0
  Soup soup = empty_soup();
  for (int j = 0; j < 5; ++j) add_quad(soup, {-0.05, j * 0.02, 0}, {0, j * 0.02, 0}, {0, (j + 1) * 0.02, 0}, {-0.05, (j + 1) * 0.02, 0});
  for (int j = 0; j < 3; ++j)
    add_quad(soup, {0, j * 0.1 / 3, 0}, {0.05, j * 0.1 / 3, 0}, {0.05, (j + 1) * 0.1 / 3, 0}, {0, (j + 1) * 0.1 / 3, 0});
  const auto plane = make_mesh(soup);
  const double r = 0.005;
  for (int i = -20; i <= 20; ++i) {
    for (int j = 1; j < 50; ++j) {
      const WallContacts found = touch(*plane, {i * 1e-4, j * 0.002, r - 1e-4}, r);
      REQUIRE(found.count() == 1);
      REQUIRE_THAT(found[0].overlap, WithinAbs(1e-4, 1e-12));
    }
  }
}

TEST_CASE("Convex edges and corners touch once, concave ones twice and three times") {
  const auto block = make_mesh(cube(0.1));
  const double r = 0.005, d = 1e-4;
  SECTION("convex edge") {
    const double s = (r - d) / std::sqrt(2.0);
    const WallContacts found = touch(*block, {0.1 + s, 0.1 + s, 0.05}, r);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-12));
    CHECK_THAT(found[0].normal.x, WithinAbs(std::sqrt(0.5), 1e-12));
  }
  SECTION("convex corner") {
    const double s = (r - d) / std::sqrt(3.0);
    const WallContacts found = touch(*block, {0.1 + s, 0.1 + s, 0.1 + s}, r);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-12));
  }
  SECTION("concave edge: the inside of the same block, since contact is two-sided") {
    const WallContacts found = touch(*block, {r - d, r - d, 0.05}, r);
    REQUIRE(found.count() == 2);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-12));
    CHECK_THAT(found[1].overlap, WithinAbs(d, 1e-12));
    CHECK_THAT(dot(found[0].normal, found[1].normal), WithinAbs(0, 1e-12));
    CHECK(found[0].feature != found[1].feature);
  }
  SECTION("concave corner") { CHECK(touch(*block, {r - d, r - d, r - d}, r).count() == 3); }
  SECTION("on a face near the edge") { CHECK(touch(*block, {0.1 - 1e-5, 0.05, 0.1 + r - d}, r).count() == 1); }
}

TEST_CASE("A tessellated cylinder touches once and keeps its feature all round") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.02;
  const Mill mill("mill", shape, 0.003, 3);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell"}));
  const double r = 0.0025;
  for (int i = 0; i < 5000; ++i) {
    const double angle = i * 1.2345e-3, rho = 0.15 - r + 5e-5;
    const WallContacts found = touch(*mesh, {rho * std::cos(angle), rho * std::sin(angle), 0.0011 + i * 3e-6}, r);
    REQUIRE(found.count() == 1);
    REQUIRE(found[0].feature == 0);
    REQUIRE_THAT(found[0].overlap, WithinAbs(5e-5, 1.1 * 0.003 * 0.003 / 8 / 0.15));  // within the sagitta of a chord
  }
}

TEST_CASE("A bead in a round groove narrower than itself touches both sides, with features of their own") {
  Soup soup = empty_soup();
  const int n = 60;
  const double rho = 0.01;
  for (int i = 0; i < n; ++i) {  // a half pipe whose rim widens: an ellipse
    const auto at = [&](int k, double z) {
      const double a = std::numbers::pi * k / n;
      return Point{0.5 * rho * std::cos(a), -2 * rho * std::sin(a), z};
    };
    add_quad(soup, at(i, 0), at(i + 1, 0), at(i + 1, 0.1), at(i, 0.1));
  }
  const auto groove = make_mesh(soup);
  REQUIRE(groove->topology().patches == 1);
  const WallContacts found = touch(*groove, {0, -0.006, 0.05}, 0.0053);
  REQUIRE(found.count() == 2);
  CHECK(found[0].feature != found[1].feature);
  CHECK_THAT(found[0].normal.x + found[1].normal.x, WithinAbs(0, 1e-9));
}

TEST_CASE("The overlap is continuous while a bead goes over edges and corners") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.02, shape.lifters = 20, shape.lifter_height = 0.005, shape.lifter_width = 0.02;
  shape.face_angle = std::numbers::pi / 3;
  const Mill mill("mill", shape, 0.003, 1);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter"}));
  const double r = 0.0025, step = 2e-6;
  const double reach = 5e-4;  // gaps too, so that nothing begins suddenly
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int path = 0; path < 20; ++path) {
    const double start = 2 * std::numbers::pi * u(random), rho = 0.1425 + 0.0045 * u(random), z = 0.004 + 0.012 * u(random);
    double last = -1;
    for (int i = 0; i < 4000; ++i) {
      const double angle = start + i * step / rho;
      const WallContacts found = touch(*mesh, {rho * std::cos(angle), rho * std::sin(angle), z}, r, reach);
      const double deepest = found.count() > 0 ? found[0].overlap : -reach;
      if (i > 0) REQUIRE(std::fabs(deepest - last) <= 1.01 * step);
      last = deepest;
    }
  }
}

TEST_CASE("Winding does not matter, nor does a centre behind the surface") {
  Soup turned = sheet(0.1, 4);
  for (std::size_t t = 0; t < turned.size(); t += 2) std::swap(turned.corners[3 * t + 1], turned.corners[3 * t + 2]);
  const auto mesh = make_mesh(turned);
  CHECK(mesh->topology().patches == 1);
  for (const double side : {1.0, -1.0}) {
    const WallContacts found = touch(*mesh, {0.04, 0.05, side * 0.0049}, 0.005);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].normal.z, WithinAbs(side, 1e-12));
    CHECK_THAT(found[0].overlap, WithinAbs(1e-4, 1e-12));
  }
}
