#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::WithinAbs;

namespace {

/// Smallest squared distance over a fine net of barycentric weights, and its refinement: slow, but without regions.
double searched(const Point& a, const Point& b, const Point& c, const Point& p) {
  double best = 1e300, u0 = 0, v0 = 0, span = 1;
  for (int level = 0; level < 12; ++level) {
    double best_u = u0, best_v = v0;
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        double u = level == 0 ? i / 20.0 : u0 + span * (i - 10) / 10.0, v = level == 0 ? j / 20.0 : v0 + span * (j - 10) / 10.0;
        u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0 - u);
        const Point d = p - (a + u * (b - a) + v * (c - a));
        if (dot(d, d) < best) best = dot(d, d), best_u = u, best_v = v;
      }
    }
    u0 = best_u, v0 = best_v, span *= level == 0 ? 0.1 : 0.3;
  }
  return best;
}

}  // namespace

TEST_CASE("The nearest point of a triangle agrees with a search, in every region") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&] { return Point{u(random), u(random), u(random)}; };
  std::set<Region> seen;
  for (int trial = 0; trial < 400; ++trial) {
    IndexedMesh mesh;
    mesh.vertices = {point(), point(), point()};
    mesh.triangles = {{0, 1, 2}};
    mesh.slots = mesh.source = {0};
    Triangles triangles;
    triangles.add(mesh, 0, 0);
    const Point p = 2.0 * point();
    const double height = triangles.height(0, p);
    const Nearest n = nearest_point(triangles, 0, p, height, 1e9);
    seen.insert(n.region);
    CHECK_THAT(std::sqrt(n.squared), WithinAbs(std::sqrt(searched(mesh.vertices[0], mesh.vertices[1], mesh.vertices[2], p)), 2e-4));
    CHECK_THAT(dot(n.to_bead, n.to_bead), WithinAbs(n.squared, 1e-12));
    // The early rejection never denies what is within the limit.
    CHECK(nearest_point(triangles, 0, p, height, n.squared * (1 + 1e-9)).squared == n.squared);
    CHECK(nearest_point(triangles, 0, p, height, 0.5 * n.squared).squared >= 0.5 * n.squared);
  }
  CHECK(seen.size() == 7);
}
