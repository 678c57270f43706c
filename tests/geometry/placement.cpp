#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "geometry/shapes/mill.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

MillShape mill_shape() {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.1, shape.lifters = 12, shape.lifter_height = 0.005, shape.lifter_width = 0.02;
  shape.face_angle = 1;
  return shape;
}

Soup mill_soup() { return soup_of(Mill("mill", mill_shape(), 0.003, 1).surface(), {"shell", "lifter"}); }

std::string refusal(const Soup& soup, const MeshOptions& options) {
  try {
    make_mesh(soup, options);
  } catch (const Refusal& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A mill that lies along any direction is brought to z and centred") {
  const Point direction = GENERATE(Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}, Point{1, 2, -0.5});
  Soup soup = mill_soup();
  const Rotation to_z = rotation_to_z((1 / length(direction)) * direction);
  for (Point& p : soup.corners) {  // the inverse: from z to the direction
    p = p.x * to_z.row[0] + p.y * to_z.row[1] + p.z * to_z.row[2];
    p = 1000.0 * p + Point{70, -30, 20};
  }
  MeshOptions options;
  options.placement.scale = 1e-3;
  options.placement.axis = "auto";
  options.placement.centre = true;
  const auto mesh = make_mesh(soup, options);
  CHECK_THAT(mesh->report(), Contains("axis: z through [0, 0, "));
  REQUIRE(mesh->interior().is_cylinder);
  CHECK_THAT(mesh->interior().radius, WithinAbs(0.15, 1e-9));
  CHECK_THAT(mesh->survey().box.extent().z, WithinAbs(0.1, 1e-9));
}

TEST_CASE("Rotations keep handedness") {
  for (const Point& d : {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}, Point{0.6, 0, 0.8}}) {
    const Rotation r = rotation_to_z(d);
    CHECK_THAT(r(d).z, WithinAbs(1, 1e-12));
    CHECK_THAT(dot(cross(r.row[0], r.row[1]), r.row[2]), WithinAbs(1, 1e-12));
  }
  const Point turned = rotation_about({0, 0, 2}, std::numbers::pi / 2)({1, 0, 0});
  CHECK_THAT(turned.y, WithinAbs(1, 1e-12));
}

TEST_CASE("One segment repeated round the axis is the whole mill") {
  const Soup whole = mill_soup();
  Soup segment = empty_soup();
  segment.names = whole.names;
  const std::size_t per_segment = whole.size() / 12;  // the surface lists lifter after lifter
  segment.corners.assign(whole.corners.begin(), whole.corners.begin() + static_cast<std::ptrdiff_t>(3 * per_segment));
  segment.slots.assign(whole.slots.begin(), whole.slots.begin() + static_cast<std::ptrdiff_t>(per_segment));
  MeshOptions options;
  options.placement.repeat = 12;
  const auto mesh = make_mesh(segment, options), full = make_mesh(whole);
  CHECK(mesh->mesh().own == full->mesh().own);
  CHECK(mesh->mesh().vertices.size() == full->mesh().vertices.size());
  CHECK(mesh->topology().open_edges == full->topology().open_edges);
  CHECK(mesh->topology().patches == full->topology().patches);
  CHECK(mesh->material_slots() == "shell|lifter");
}

TEST_CASE("Impossible placements are refused with the remedy") {
  MeshOptions options;
  options.label = "part.stl";
  SECTION("a mill in millimetres read as metres") {
    options.placement.scale = 1000;
    CHECK_THAT(refusal(mill_soup(), options), Contains("part.stl") && Contains("299.4 m") && Contains("unit"));
  }
  SECTION("a mill in metres read as millimetres") {
    options.placement.scale = 1e-3;
    CHECK_THAT(refusal(mill_soup(), options), Contains("unit (it would fit in:"));
  }
  SECTION("no axis") {
    options.placement.axis = "auto";
    CHECK_THAT(refusal(cube(0.1), options), Contains("finds no axis") && Contains("axis: x, y or z"));
  }
  SECTION("angle without axis") {
    options.placement.rotate_angle = 1;
    CHECK_THAT(refusal(cube(0.1), options), Contains("rotate_axis: [0, 0, 1]"));
  }
  SECTION("wrong period") {
    options.period = 0.3;
    CHECK_THAT(refusal(cube(0.1), options), Contains("0.3 m") && Contains("0.1 m"));
  }
  SECTION("too many after repeating") {
    options.placement.repeat = 100;
    options.max_triangles = 1000;
    CHECK_THAT(refusal(cube(0.1), options), Contains("1200 triangles") && Contains("max_triangles"));
  }
  SECTION("nothing left") {
    Soup flat = empty_soup();
    add_triangle(flat, {0, 0, 0}, {0.1, 0, 0}, {0.05, 0, 0});
    CHECK_THAT(refusal(flat, options), Contains("without area"));
  }
}
