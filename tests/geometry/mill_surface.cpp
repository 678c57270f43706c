#include "geometry/shapes/mill_surface.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "geometry/shapes/mill.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("The triangles of a closed mill are watertight, face inwards and have the exact end areas") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.1, shape.lifter_height = 0.005, shape.lifter_width = 0.02, shape.end_faces = true;
  shape.lifters = GENERATE(0, 1, 2, 3, 20);
  shape.face_angle = GENERATE(std::numbers::pi / 2, std::numbers::pi / 3);
  const bool awkward = shape.lifters > 0 && shape.lifters < 3 && shape.face_angle > 1.5;  // a fan that overlaps itself a little
  const Mill mill("mill", shape, 0.003, 3);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter", "end"}));
  CHECK(mesh->mesh().degenerate == 0);
  CHECK(mesh->mesh().duplicate == 0);
  CHECK(mesh->topology().open_edges == 0);
  CHECK(mesh->topology().crowded_edges == 0);
  CHECK(mesh->topology().turned_edges == 0);
  CHECK(mesh->topology().parts == 1);
  const double section = std::numbers::pi * 0.15 * 0.15 - MillProfile(shape).lifter_area();
  CHECK_THAT(mesh->survey().volume, WithinRel(-section * 0.1, 1e-3));
  const Surface s = mill.surface();
  double ends = 0;
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    if (s.triangle_materials[t] == (shape.lifters > 0 ? 2U : 1U)) ends += 0.5 * length(double_area(mesh->mesh(), t));
  }
  if (!awkward) CHECK_THAT(ends, WithinRel(2 * section, 1e-3));
}

TEST_CASE("A contact names the triangle under it") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.1, shape.lifters = 7, shape.lifter_height = 0.005, shape.lifter_width = 0.02, shape.face_angle = 1;
  shape.phase = 0.3;
  Mill mill("mill", shape, 0.002, 5);
  const Surface s = mill.surface();
  const auto mesh = make_mesh(soup_of(s, {"shell", "lifter"}));
  const Triangles& triangles = mesh->contact().triangles();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  int checked = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const double angle = 2 * std::numbers::pi * u(random), rho = 0.14 + 0.0095 * u(random), r = 0.0025;
    const Point p{rho * std::cos(angle), rho * std::sin(angle), 0.1 * u(random)};
    const WallContacts found = touch(mill, p, r);
    for (int i = 0; i < found.count(); ++i) {
      if (found[i].overlap > r) continue;
      REQUIRE(found[i].triangle < s.triangle_count);
      const Point place = p - (r - found[i].overlap) * found[i].normal;
      const double height = triangles.height(found[i].triangle, place);
      REQUIRE(std::sqrt(nearest_point(triangles, found[i].triangle, place, height, 1e9).squared) < 1e-5);
      ++checked;
    }
  }
  CHECK(checked > 1000);
}

TEST_CASE("Vertices of the shell lie on the true radius, chords are no longer than asked") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.1;
  const Mill mill("mill", shape, 0.003, 1);
  const Surface s = mill.surface();
  for (std::uint64_t i = 0; i < s.vertex_count; ++i)
    CHECK_THAT(std::hypot(s.vertices[3 * i], s.vertices[3 * i + 1]), WithinAbs(0.15, 1e-15));
  const Point a{s.vertices[0], s.vertices[1], s.vertices[2]}, b{s.vertices[3], s.vertices[4], s.vertices[5]};
  CHECK(length(b - a) <= 0.003);
}
