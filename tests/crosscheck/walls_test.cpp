#include "studies/engine/liggghts/walls.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace millscope::engine::liggghts {
namespace {

/// A wall along z over corners in x, y, two triangles from each to the next.
double smooth_of(const std::vector<std::array<double, 2>>& corners, double lean = 0) {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto low = static_cast<std::uint32_t>(2 * i);
    vertices.insert(vertices.end(), {corners[i][0], corners[i][1], 0, corners[i][0] + lean, corners[i][1], 1});
    if (i + 1 < corners.size()) triangles.insert(triangles.end(), {low, low + 2, low + 1, low + 1, low + 2, low + 3});
  }
  dem::Motion motion;
  motion.axis = {0, 0, 1};
  return smooth_degrees({vertices.size() / 3, vertices.data(), triangles.size() / 3, triangles.data(), nullptr}, triangles, motion);
}

/// From 6 o'clock, angles in degrees.
std::array<double, 2> on_circle(double radius, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {radius * std::sin(angle), -radius * std::cos(angle)};
}

}  // namespace

TEST_CASE("the facets of a hollow shell are one surface") {
  std::vector<std::array<double, 2>> shell;
  for (int k = 0; k <= 72; ++k) shell.push_back(on_circle(1, 5 * k));
  CHECK(smooth_of(shell) == kSmoothDegrees);
}

TEST_CASE("a lifter with sharp edges leaves its shell one surface") {
  CHECK(smooth_of({on_circle(1, -10), on_circle(1, -5), {-0.05, -0.95}, {0.05, -0.95}, on_circle(1, 5), on_circle(1, 10)}) ==
        kSmoothDegrees);
}

TEST_CASE("the edges of a round lifter push, for over a ridge no face does") {
  // The top of the lifter is an arc of 0.1 round (0, −1), in steps of 12°.
  std::vector<std::array<double, 2>> lifter{on_circle(1, -15), on_circle(1, -10)};
  for (int k = -3; k <= 3; ++k)
    lifter.push_back({-0.1 * std::sin(-12 * k * std::numbers::pi / 180), -1 + 0.1 * std::cos(12 * k * std::numbers::pi / 180)});
  lifter.push_back(on_circle(1, 10));
  CHECK(smooth_of(lifter) == Approx(0.9 * 12));
}

TEST_CASE("a flat wall is one surface, whichever way it is cut") {
  CHECK(smooth_of({{-1, -1}, {0, -1}, {1, -1}}) == kSmoothDegrees);
  CHECK(smooth_of({{-1, -1}, {0, -1}, {1, -1}}, 0.3) == kSmoothDegrees);
}

TEST_CASE("a sharp ridge that bends a little keeps its bend") {
  // Two lengths of a roof whose ridge turns by 8° where they meet.
  const double bend = 8 * std::numbers::pi / 180, s = std::sin(bend), c = std::cos(bend);
  const std::vector<double> vertices{-0.2, -1,  0,  0, -0.8,     0,  0.2,   -1, 0,    -0.2,  -1,      1,  0,    -0.8,
                                     1,    0.2, -1, 1, -0.2 + s, -1, 1 + c, s,  -0.8, 1 + c, 0.2 + s, -1, 1 + c};
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t a : {0U, 1U, 3U, 4U}) triangles.insert(triangles.end(), {a, a + 1, a + 3, a + 1, a + 4, a + 3});
  dem::Motion motion;
  motion.axis = {0, 0, 1};
  const double found =
      smooth_degrees({vertices.size() / 3, vertices.data(), triangles.size() / 3, triangles.data(), nullptr}, triangles, motion);
  CHECK(found < 0.9 * 8 + 1e-6);
  CHECK(found > 3);
}

}  // namespace millscope::engine::liggghts
