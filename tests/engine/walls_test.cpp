#include "studies/engine/liggghts/walls.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

namespace millscope::engine::liggghts {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Mesh {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles;
};

double smooth_of(const Mesh& mesh, bool is_round = true) {
  Interior inside{};
  inside.is_cylinder = is_round ? 1 : 0;
  inside.axis[2] = 1, inside.radius = 1;
  const Surface surface{mesh.vertices.size() / 3, mesh.vertices.data(), mesh.triangles.size() / 3, mesh.triangles.data(), nullptr};
  return smooth_degrees(surface, inside, mesh.triangles);
}

using Corner = std::array<double, 2>;

/// A wall along z over corners in x, y, two triangles from each to the next, a tenth of a radius long.
Mesh along_z(const std::vector<Corner>& corners, double length = 0.1) {
  Mesh mesh;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto low = static_cast<std::uint32_t>(2 * i);
    mesh.vertices.insert(mesh.vertices.end(), {corners[i][0], corners[i][1], 0, corners[i][0], corners[i][1], length});
    if (i + 1 < corners.size()) mesh.triangles.insert(mesh.triangles.end(), {low, low + 2, low + 1, low + 1, low + 2, low + 3});
  }
  return mesh;
}

/// From 6 o'clock, angles in degrees.
Corner on_circle(double radius, double degrees) { return {radius * std::sin(degrees * kDegree), -radius * std::cos(degrees * kDegree)}; }

/// The corners, closed into a ring by the shell from their last to their first.
std::vector<Corner> in_shell(std::vector<Corner> corners, double from, double to) {
  for (double angle = from; angle < to; angle += 5) corners.push_back(on_circle(1, angle));
  corners.push_back(corners.front());
  return corners;
}

/// The last corner is the first: one vertex.
Mesh closed(Mesh mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size() / 3);
  for (std::uint32_t& v : mesh.triangles) v = v >= count - 2 ? v - (count - 2) : v;
  return mesh;
}

}  // namespace

TEST_CASE("the facets of a hollow shell are one surface") {
  CHECK(smooth_of(closed(along_z(in_shell({}, 0, 359)))) == kSmoothDegrees);
  CHECK(smooth_of(closed(along_z(in_shell({}, 0, 359))), false) == kJoinedAnyway);  // nothing is known of the inside
}

TEST_CASE("a lifter with sharp edges leaves its shell one surface") {
  CHECK(smooth_of(closed(along_z(in_shell({on_circle(1, -5), {-0.05, -0.95}, {0.05, -0.95}}, 5, 350)))) == kSmoothDegrees);
}

TEST_CASE("the edges of a round lifter push, for over a ridge no face does") {
  std::vector<Corner> lifter{on_circle(1, -10)};  // its top: an arc of 0.1 round 6 o'clock, in steps of 12 degrees
  for (int k = -3; k <= 3; ++k) lifter.push_back({0.1 * std::sin(12 * k * kDegree), -1 + 0.1 * std::cos(12 * k * kDegree)});
  CHECK(smooth_of(closed(along_z(in_shell(lifter, 10, 345)))) == Approx(0.9 * 12));
}

TEST_CASE("the flank of an undercut lifter that bends towards the solid is a ridge") {
  CHECK(smooth_of(closed(along_z(in_shell({{-0.1, -0.99499}, {-0.1, -0.93}, {0.0293, -0.93}, {0.02, -0.965}, {0.0, -1.0}}, 5, 350)))) <
        0.91 * 15.3);
}

TEST_CASE("a shaft in the middle of the charge is met from behind") {
  std::vector<Corner> shaft;
  for (int k = 0; k <= 36; ++k) shaft.push_back(on_circle(0.2, 10 * k));
  CHECK(smooth_of(closed(along_z(shaft))) == Approx(0.9 * 10));
}

TEST_CASE("a corner in the open stays awake: LIGGGHTS puts it to sleep where two of its edges make a smaller angle") {
  // A block that stops short of the shell's ends: top, a flank and an end face meet in its corners. Slender faces: 0.02 by 0.5.
  Mesh mesh = closed(along_z(in_shell({}, 0, 359), 1.0));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size() / 3);
  for (const double z : {0.25, 0.75}) {
    for (const Corner& c : {Corner{-0.01, -1}, Corner{-0.01, -0.95}, Corner{0.01, -0.95}, Corner{0.01, -1}})
      mesh.vertices.insert(mesh.vertices.end(), {c[0], c[1], z});
  }
  for (const std::array<std::uint32_t, 3>& t : {std::array{0U, 4U, 1U},
                                                {1U, 4U, 5U},
                                                {1U, 5U, 2U},
                                                {2U, 5U, 6U},
                                                {2U, 6U, 3U},
                                                {3U, 6U, 7U},
                                                {0U, 1U, 2U},
                                                {0U, 2U, 3U},
                                                {4U, 6U, 5U},
                                                {4U, 7U, 6U}}) {
    for (const std::uint32_t v : t) mesh.triangles.push_back(first + v);
  }
  CHECK(smooth_of(mesh) <= Approx(0.9 * std::atan(0.02 / 0.5) / kDegree));
  CHECK(smooth_of(mesh) > 1);
}

TEST_CASE("a sharp ridge that bends a little keeps its bend") {
  // Two lengths of a roof whose ridge turns by 8 degrees where they meet.
  const double s = std::sin(8 * kDegree), c = std::cos(8 * kDegree);
  const Mesh roof{
      {-0.2, -1, 0, 0, -0.8, 0, 0.2, -1, 0, -0.2, -1, 1, 0, -0.8, 1, 0.2, -1, 1, -0.2 + s, -1, 1 + c, s, -0.8, 1 + c, 0.2 + s, -1, 1 + c},
      {0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4, 3, 4, 6, 4, 7, 6, 4, 5, 7, 5, 8, 7}};
  CHECK(smooth_of(roof) < 0.9 * 8 + 1e-6);
  CHECK(smooth_of(roof) > 1);
}

}  // namespace millscope::engine::liggghts
