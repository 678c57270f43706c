// Profiles of liners: pitches, heights, ends; and back to triangles.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"
#include "studies/wear/worn_mesh.hpp"

using namespace dem_test;
using Catch::Contains;
using namespace millscope::wear;

namespace {

/// A mill of 200 mm by 40 mm.
Assembly mill(const std::string& more, bool periodic = true) {
  Setup s;
  s.geometry = "{liner: {kind: mill, diameter: 200 mm, length: 40 mm, facet: 1 mm, material: wall, motion: {rotation: {speed: 5 rad/s}}, " +
               more + "}}";
  if (periodic) s.domain = "{periodic: {z: [0, 40 mm]}}";
  return assembled(s);
}

Profile profile(const Assembly& a, const Resolution& resolution = {1e-3, 1, 0}) {
  return profile_of(a.geometries[0].surface, a.geometries[0].interior, resolution, "liner");
}

}  // namespace

TEST_CASE("a liner's pitches are counted and its lifters measured") {
  const Profile p = profile(mill("lifters: 10, lifter_height: 8 mm, lifter_width: 20 mm"));
  CHECK(p.pitches == 10);
  CHECK(p.relief() == Approx(8e-3).epsilon(0.02));
  CHECK_FALSE(p.low_face);
  CHECK(p.low == Approx(0).margin(1e-12));
  CHECK(p.high == Approx(0.04));
  const Profile one = profile(mill("lifters: 10, lifter_height: 8 mm, lifter_width: 20 mm"), {1e-3, 1, 1});
  CHECK(one.pitches == 1);
  CHECK(one.relief() == Approx(p.relief()).epsilon(0.01));
}

TEST_CASE("a smooth shell has as many pitches as one likes, and ends are seen") {
  const Profile p = profile(mill("lifters: 0, end_faces: true", false), {1e-3, 4, 0});
  CHECK(p.pitches == 60);
  CHECK(p.relief() < 1e-5);
  CHECK(p.low_face);
  CHECK(p.high_face);
  CHECK(p.rows == 4);
}

TEST_CASE("upright faces, and as many lifters as no round number of directions has, are counted too") {
  for (const int lifters : {7, 14, 22}) {
    INFO(lifters);
    const Profile p =
        profile(mill(fmt::format("lifters: {}, lifter_height: 8 mm, lifter_width: 12 mm, lifter_face_angle: 90 deg", lifters)));
    CHECK(p.pitches == lifters);
    CHECK(p.relief() == Approx(8e-3).epsilon(0.03));
  }
}

TEST_CASE("of a liner longer than the slice only the slice counts") {
  const Assembly a = mill("lifters: 10, lifter_height: 8 mm, lifter_width: 20 mm");
  Resolution r{1e-3, 1, 0};
  r.period = {0.01, 0.03};
  const Profile p = profile(a, r);
  CHECK(p.low == 0.01);
  CHECK(p.row_length() == Approx(0.02));
  CHECK(p.periodic);
}

TEST_CASE("a number of pitches that a liner has not is refused with what they differ by") {
  const Assembly a = mill("lifters: 10, lifter_height: 8 mm, lifter_width: 20 mm");
  CHECK_THROWS_WITH(profile(a, {1e-3, 1, 7}), Contains("does not repeat 7 times") && Contains("--pitches"));
}

TEST_CASE("lifters that wind along the mill are refused for one row, and taken with several") {
  const Assembly a = mill("lifters: 10, lifter_height: 8 mm, lifter_width: 20 mm");
  millscope::Surface s = a.geometries[0].surface;
  std::vector<double> wound(s.vertices, s.vertices + 3 * s.vertex_count);
  for (std::size_t v = 0; v < wound.size(); v += 3) {
    const double angle = 0.5 * wound[v + 2] / 0.04, c = std::cos(angle), sine = std::sin(angle);
    const double x = wound[v], y = wound[v + 1];
    wound[v] = c * x - sine * y;
    wound[v + 1] = sine * x + c * y;
  }
  s.vertices = wound.data();
  const auto with = [&](std::size_t rows) { return profile_of(s, a.geometries[0].interior, {1e-3, rows, 0}, "liner"); };
  CHECK_THROWS_WITH(with(1), Contains("geometry.liner") && Contains("not the same along the mill") && Contains("--rows"));
  const Profile rows = with(8);
  CHECK(rows.pitches == 10);
  const std::size_t around = rows.radius.size() / 8;  // the first row and the last are not alike
  double apart = 0;
  for (std::size_t k = 0; k < around; ++k) apart = std::max(apart, std::fabs(rows.radius[k] - rows.radius[7 * around + k]));
  CHECK(apart > 4e-3);
}

TEST_CASE("a profile as triangles has the same profile, the volume of its liner and materials on both sides of a border") {
  for (const char* lifters : {"lifters: 8, lifter_height: 6 mm, lifter_width: 20 mm",
                              "lifters: 8, lifter_height: 6 mm, lifter_width: 20 mm, lifter_face_angle: 90 deg"}) {
    INFO(lifters);
    const Assembly a = mill(lifters);
    const Profile p = profile(a);
    const Stretches s = stretches_of(p);
    const Mesh mesh = mesh_of(p, s);
    const Profile again = profile_of(mesh.surface(), a.geometries[0].interior, {1e-3, 1, p.pitches}, "liner");
    REQUIRE(again.columns == p.columns);
    for (std::size_t c = 0; c < p.columns; ++c) CHECK(again.at(0, c) == Approx(p.at(0, c)).epsilon(1e-7));
    CHECK(again.material == p.material);
    double longest = 0;
    for (const double length : lengths_of(p, s, 0)) longest = std::max(longest, length);
    CHECK(longest < 1.6e-3);
  }
}

TEST_CASE("the triangles of a liner look towards the beads") {
  const Profile p = profile(mill("lifters: 8, lifter_height: 6 mm, lifter_width: 20 mm, end_faces: true", false), {1e-3, 3, 0});
  const Mesh mesh = mesh_of(p, stretches_of(p));
  double volume = 0;  // enclosed, by the divergence theorem, with normals inwards
  for (std::size_t t = 0; t < mesh.materials.size(); ++t) {
    const double* v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = &mesh.vertices[std::size_t{3} * mesh.triangles[3 * t + k]];
    volume -= (v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
               v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])) /
              6;
  }
  double area = 0;
  for (std::size_t c = 0; c < p.columns; ++c) area += 0.5 * std::sin(p.step()) * p.at(0, c) * p.at(0, c + 1);
  CHECK(volume == Approx(area * p.pitches * 0.04).epsilon(1e-9));
}

TEST_CASE("what triangles have lost comes to the stretch and the row where they lie, and nothing gets lost") {
  const Assembly a = mill("lifters: 8, lifter_height: 6 mm, lifter_width: 20 mm, end_faces: true", false);
  const Profile p = profile(a, {1e-3, 3, 0});
  const Stretches s = stretches_of(p);
  const Mesh mesh = mesh_of(p, s);
  run::WornSurface worn{mesh.vertices, mesh.triangles, mesh.materials, std::vector<double>(mesh.materials.size(), 0.0), 2.0};
  const std::size_t ring = static_cast<std::size_t>(p.pitches) * s.count();
  for (std::size_t t = 0; t < worn.worn.size(); ++t) worn.worn[t] = t < 2 * ring * p.rows ? 1.0 + static_cast<double>(t / (2 * ring)) : 5.0;
  const Loss loss = loss_of(worn, p, s);
  CHECK(loss.faces == Approx(5.0 * 2 * static_cast<double>(ring) / 2));
  for (const std::vector<double>& pitch : loss.of_pitch) {
    for (std::size_t k = 0; k < pitch.size(); ++k) CHECK(pitch[k] == Approx(1.0 + static_cast<double>(k / s.count())));
  }
}

TEST_CASE("an even loss stays even, at the ends of a closed mill and over the period of a slice") {
  for (const bool periodic : {false, true}) {
    Profile p = profile(mill("lifters: 0"), {1e-3, 12, 0});
    p.periodic = periodic;
    const Stretches s = stretches_of(p);
    std::vector<double> loss = lengths_of(p, s, 0);
    std::vector<double> all;
    for (std::size_t row = 0; row < p.rows; ++row) all.insert(all.end(), loss.begin(), loss.end());
    const std::vector<double> before = all;
    smooth(all, p, s, 6e-3);
    for (std::size_t k = 0; k < all.size(); ++k) CHECK(all[k] == Approx(before[k]).epsilon(2e-3));
  }
}

TEST_CASE("the rows of a slice join over its period") {
  Profile p = profile(mill("lifters: 0"), {1e-3, 2, 0});
  p.periodic = true;
  for (std::size_t c = 0; c < p.columns; ++c) p.at(1, c) += 1e-3;
  const Mesh mesh = mesh_of(p, stretches_of(p));
  const std::size_t ring = mesh.vertices.size() / 9;
  for (std::size_t k = 0; k < ring; ++k) {
    CHECK(mesh.vertices[3 * k] == mesh.vertices[3 * (2 * ring + k)]);
    CHECK(mesh.vertices[3 * k + 1] == mesh.vertices[3 * (2 * ring + k) + 1]);
  }
}

TEST_CASE("smoothing spreads over the surface and keeps the sum") {
  const Assembly a = mill("lifters: 8, lifter_height: 6 mm, lifter_width: 20 mm");
  const Profile p = profile(a, {1e-3, 4, 0});
  const Stretches s = stretches_of(p);
  std::vector<double> loss(p.rows * s.count(), 0.0);
  loss[5] = 1, loss[s.count() + 20] = 2;
  smooth(loss, p, s, 2e-3);
  double sum = 0, greatest = 0;
  for (const double v : loss) sum += v, greatest = std::max(greatest, v);
  CHECK(sum == Approx(3).epsilon(1e-12));
  CHECK(greatest < 1);
  CHECK(loss[4] == Approx(loss[6]).epsilon(0.1));
}
