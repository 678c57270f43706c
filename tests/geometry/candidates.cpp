#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <thread>

#include "geometry/shapes/mill.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;

namespace {

std::vector<std::uint32_t> all_within(const Triangles& triangles, const Point& p, double reach) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (nearest_point(triangles, t, p, triangles.height(t, p), 1e9).squared <= reach * reach) found.push_back(t);
  }
  return found;
}

std::vector<Point> cloud(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) points.push_back({0.16 * u(random), 0.16 * u(random), 0.02 + 0.025 * u(random)});
  return points;
}

}  // namespace

TEST_CASE("Candidates are exactly the triangles within radius and margin") {
  MillShape shape;
  shape.radius = 0.15, shape.length = 0.04, shape.lifters = 20, shape.lifter_height = 0.005, shape.lifter_width = 0.02;
  shape.face_angle = std::numbers::pi / 3, shape.end_faces = true;
  const Mill mill("mill", shape, 0.004, 4);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter", "end"}));
  const Triangles& triangles = mesh->contact().triangles();
  std::size_t total = 0;
  // Again and again, with other beads, counts and margins: what is remembered of earlier rebuilds must not show.
  for (const auto& [count, margin] : {std::pair{300, 0.0005}, {50, 0.0002}, {400, 0.0009}, {1, 0.003}, {300, 0.0005}}) {
    const std::vector<Point> points = cloud(count, static_cast<unsigned>(count));
    const auto found = candidates_of(*mesh, points, 0.0025, margin);
    for (std::size_t i = 0; i < points.size(); ++i) {
      REQUIRE(found[i] == all_within(triangles, points[i], 0.0025 + margin));
      total += found[i].size();
    }
  }
  CHECK(total > 500);
}

TEST_CASE("Whichever side of a box is the longest, the same triangles are near") {
  std::array<double, 3> sides{1, 2, 5};  // of the cube's
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-0.05, 1.05);
  do {
    INFO(sides[0] << " by " << sides[1] << " by " << sides[2]);
    Soup soup = cube(0.02);
    for (Point& p : soup.corners) p = {p.x * sides[0], p.y * sides[1], p.z * sides[2]};
    const auto box = make_mesh(soup);
    std::vector<Point> points;
    for (int i = 0; i < 400; ++i) points.push_back({0.02 * sides[0] * u(random), 0.02 * sides[1] * u(random), 0.02 * sides[2] * u(random)});
    const auto found = candidates_of(*box, points, 0.002, 0.0005);
    for (std::size_t i = 0; i < points.size(); ++i) REQUIRE(found[i] == all_within(box->contact().triangles(), points[i], 0.0025));
  } while (std::next_permutation(sides.begin(), sides.end()));
}

TEST_CASE("Beads outside the grid or with absurd values are no candidates and harm nothing") {
  const auto mesh = make_mesh(cube(0.1));
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto found = candidates_of(*mesh, {{1e6, 0, 0}, {-1e300, 0, 0}, {inf, 0, 0}, {nan, nan, nan}, {0.05, 0.05, 0.1}}, 0.001, 0.001);
  for (std::size_t i = 0; i < 4; ++i) CHECK(found[i].empty());
  CHECK(found[4].size() == 2);
}

TEST_CASE("A periodic slice feels its neighbour across both ends") {
  Soup soup = sheet(0.02, 2);  // stands upright: x stays, y becomes z
  for (Point& p : soup.corners) p = {p.x, 0, p.y};
  MeshOptions options;
  options.period = 0.02;
  const auto slice = make_mesh(soup, options);
  CHECK(slice->surface().triangle_count == 8);
  for (const double z : {-0.002, 0.0, 0.001, 0.019, 0.02, 0.022}) {
    const WallContacts found = touch(*slice, {0.01, 0.0049, z}, 0.005);
    REQUIRE(found.count() == 1);
    CHECK(std::fabs(found[0].normal.y - 1) < 1e-12);
    CHECK(found[0].triangle < 8);
  }
}

TEST_CASE("Several threads that ask for candidates at once get what one would get") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(0, 0.1);
  std::vector<std::vector<Point>> places(4);
  for (std::vector<Point>& p : places) {
    for (int i = 0; i < 500; ++i) p.push_back({u(random), u(random), u(random)});
  }
  const auto alone = make_mesh(cube(0.1)), shared = make_mesh(cube(0.1));
  std::vector<std::vector<std::vector<std::uint32_t>>> found(places.size());
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < places.size(); ++k) {
    threads.emplace_back([&, k] { found[k] = candidates_of(*shared, places[k], 0.002, 0.001 * static_cast<double>(k)); });
  }
  for (std::thread& t : threads) t.join();
  for (std::size_t k = 0; k < places.size(); ++k)
    CHECK(found[k] == candidates_of(*alone, places[k], 0.002, 0.001 * static_cast<double>(k)));
}
