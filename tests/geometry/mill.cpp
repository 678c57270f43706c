// The exact outline against a search over a fine polyline, and against its own triangles read back as a mesh.
#include "geometry/shapes/mill.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

MillShape study() {
  MillShape s;
  s.radius = 0.15, s.length = 0.27, s.lifters = 20, s.lifter_height = 0.005, s.lifter_width = 0.02;
  s.face_angle = std::numbers::pi / 3, s.phase = 0.1, s.end_faces = true;
  return s;
}

/// The centre is before every wall by a distance that leaves overlaps of at most a fifth of a bead: deeper in the corner at a foot, a
/// chord, whose normal differs from that of its arc, may be under the centre where the arc is not.
bool is_free(Mill& mill, const Point& p) {
  const WallContacts found = touch(mill, p, 0.002);
  for (int i = 0; i < found.count(); ++i) {
    if (found[i].normal.z == 0) return false;  // an end does not count
  }
  return true;
}

void compare(const WallContacts& exact, const WallContacts& mesh, double tolerance) {
  REQUIRE(exact.count() == mesh.count());
  for (int i = 0; i < exact.count(); ++i) {  // the order may differ: the nearest in direction is meant
    int best = 0;
    for (int k = 1; k < mesh.count(); ++k) {
      if (dot(mesh[k].normal, exact[i].normal) > dot(mesh[best].normal, exact[i].normal)) best = k;
    }
    REQUIRE_THAT(mesh[best].overlap, WithinAbs(exact[i].overlap, tolerance));
    REQUIRE(dot(mesh[best].normal, exact[i].normal) > 0.9998);  // half a chord of 3 mm turns it by 0.6 degrees
    REQUIRE(mesh[best].material == exact[i].material);
  }
}

}  // namespace

TEST_CASE("The mill and its triangles read back as a mesh give the same contacts") {
  MillShape shape = study();
  shape.end_faces = GENERATE(true, false);
  shape.face_angle = GENERATE(std::numbers::pi / 3, std::numbers::pi / 2);
  Mill mill("mill", shape, 0.003, 2);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter", "end"}));
  const double sagitta = 0.003 * 0.003 / 8 / 0.15, r = 0.0025;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  int contacts = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const double angle = 2 * std::numbers::pi * u(random), rho = 0.14 + 0.009 * u(random), z = 0.27 * u(random);
    const Point p{rho * std::cos(angle), rho * std::sin(angle), z};
    if (!is_free(mill, p)) continue;
    const WallContacts exact = touch(mill, p, r);
    bool clear = true;  // of the limits of contact, where one may see a touch that the other just misses
    const WallContacts with_gaps = touch(mill, p, r, 3 * sagitta);
    for (int i = 0; i < with_gaps.count(); ++i) clear &= std::fabs(with_gaps[i].overlap) > 2 * sagitta;
    if (!clear) continue;
    contacts += exact.count();
    compare(exact, touch(*mesh, p, r), 1.1 * sagitta);
  }
  CHECK(contacts > 2000);
}

TEST_CASE("Known places of the outline") {
  MillShape shape = study();
  shape.phase = 0, shape.end_faces = false;
  Mill mill("mill", shape, 0.003, 1);
  const double r = 0.0025, d = 5e-5, top = 0.145, half = 0.01 - 0.005 / std::tan(shape.face_angle);
  SECTION("shell") {
    const double angle = std::numbers::pi / 20;
    const double rho = 0.15 - r + d;
    const WallContacts found = touch(mill, {rho * std::cos(angle), rho * std::sin(angle), 0.1}, r);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-15));
    CHECK(found[0].material == 0);
  }
  SECTION("top of lifter 0, flat") {
    const WallContacts found = touch(mill, {top - r + d, 0.5 * half, 0.1}, r);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-15));
    CHECK_THAT(found[0].normal.x, WithinAbs(-1, 1e-15));
    CHECK(found[0].material == 1);
  }
  SECTION("corner: the normal turns, the feature stays that of the top") {
    const double s = (r - d) / std::sqrt(2.0);
    const WallContacts found = touch(mill, {top - s, half + s, 0.1}, r);
    REQUIRE(found.count() == 1);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-12));
    CHECK_THAT(found[0].normal.y, WithinAbs(std::sqrt(0.5), 1e-12));
    CHECK(found[0].feature == touch(mill, {top - r + d, 0, 0.1}, r)[0].feature);
  }
  SECTION("foot: shell and face") {
    const MillProfile profile(shape);
    const double a = shape.face_angle, nu = -std::cos(a), nv = std::sin(a);  // normal of the front face
    // Centre at r − d from the face line and from the shell.
    double low = 0, high = 0.02, along = 0;
    for (int i = 0; i < 80; ++i) {
      along = 0.5 * (low + high);
      const double x = top + along * std::sin(a) + (r - d) * nu, y = half + along * std::cos(a) + (r - d) * nv;
      (std::hypot(x, y) < 0.15 - (r - d) ? low : high) = along;
    }
    const WallContacts found = touch(mill, {top + along * std::sin(a) + (r - d) * nu, half + along * std::cos(a) + (r - d) * nv, 0.1}, r);
    REQUIRE(found.count() == 2);
    CHECK_THAT(found[0].overlap, WithinAbs(d, 1e-12));
    CHECK_THAT(found[1].overlap, WithinAbs(d, 1e-12));
    CHECK(found[0].feature != found[1].feature);
  }
  SECTION("between two lifters that are closer than the bead") {
    shape.lifters = 40;
    Mill narrow("mill", shape, 0.003, 1);
    const double angle = std::numbers::pi / 40;
    for (double rho = 0.13; rho < 0.145; rho += 1e-4) {
      const WallContacts found = touch(narrow, {rho * std::cos(angle), rho * std::sin(angle), 0.1}, 0.006);
      if (found.count() == 0) continue;
      REQUIRE(found.count() == 2);
      CHECK_THAT(found[0].overlap, WithinAbs(found[1].overlap, 1e-12));
      break;
    }
  }
}

TEST_CASE("A bead pushed deep into a wall is pushed out again") {
  MillShape shape = study();
  shape.phase = 0;
  Mill mill("mill", shape, 0.003, 1);
  const WallContacts beyond = touch(mill, {0.1505 * std::cos(0.157), 0.1505 * std::sin(0.157), 0.1}, 0.0025);
  REQUIRE(beyond.count() >= 1);
  CHECK(beyond[0].overlap > 0.0025);
  CHECK(beyond[0].normal.x < -0.9);
  const WallContacts within = touch(mill, {0.146, 0, 0.1}, 0.0025);
  REQUIRE(within.count() == 1);
  CHECK_THAT(within[0].overlap, WithinAbs(0.0035, 1e-12));
  CHECK_THAT(within[0].normal.x, WithinAbs(-1, 1e-12));
  const WallContacts end = touch(mill, {0, 0, -0.001}, 0.0025);
  REQUIRE(end.count() == 1);
  CHECK_THAT(end[0].overlap, WithinAbs(0.0035, 1e-12));
}

TEST_CASE("Any number of lifters, any angle: the mesh agrees") {
  MillShape shape = study();
  shape.lifters = GENERATE(0, 1, 2, 3, 8);
  shape.end_faces = false;
  Mill mill("mill", shape, 0.001, 1);
  const auto mesh = make_mesh(soup_of(mill.surface(), {"shell", "lifter"}));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 3000; ++trial) {
    const double angle = 2 * std::numbers::pi * u(random), rho = 0.15 - 0.02 * u(random);
    const Point p{rho * std::cos(angle), rho * std::sin(angle), 0.27 * u(random)};
    if (!is_free(mill, p)) continue;
    const WallContacts exact = touch(mill, p, 0.006), found = touch(*mesh, p, 0.006);
    if (exact.count() == 0 || exact[0].overlap < 1e-5) continue;
    double deepest = 0, mesh_deepest = 0;
    for (int i = 0; i < exact.count(); ++i) deepest = std::max(deepest, exact[i].overlap);
    for (int i = 0; i < found.count(); ++i) mesh_deepest = std::max(mesh_deepest, found[i].overlap);
    REQUIRE_THAT(mesh_deepest, WithinAbs(deepest, 2e-6));
  }
}

TEST_CASE("What a bead may touch until the next rebuild is among its candidates, and packs find what single beads do") {
  MillShape shape = study();
  shape.lifters = GENERATE(0, 1, 2, 3, 20);
  Mill mill("mill", shape, 0.003, 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  constexpr int kBeads = 4000;
  std::vector<Point> before, after;
  for (int i = 0; i < kBeads; ++i) {
    const double angle = 2 * std::numbers::pi * u(random), rho = 0.13 + 0.02 * u(random), z = 0.27 * u(random),
                 turn = 2 * std::numbers::pi * u(random);
    before.push_back({rho * std::cos(angle), rho * std::sin(angle), z});
    after.push_back(before.back() + Point{0.003 * std::cos(turn), 0.003 * std::sin(turn), 0});
  }
  const double radius = 0.0025, margin = 0.003;  // a bead or a wall may move by the margin
  const auto near = candidates_of(mill, before, radius, margin);
  std::vector<double> x, y, z, r(kBeads, radius);
  std::vector<std::int64_t> first{0};
  std::vector<std::uint32_t> candidates;
  int touching = 0;
  for (int i = 0; i < kBeads; ++i) {
    const WallContacts listed = contacts_of(mill, after[i], radius, near[i]), all = touch(mill, after[i], radius);
    REQUIRE(listed.count() == all.count());
    touching += all.count();
    x.push_back(after[i].x), y.push_back(after[i].y), z.push_back(after[i].z);
    candidates.insert(candidates.end(), near[i].begin(), near[i].end());
    first.push_back(std::ssize(candidates));
  }
  CHECK(touching > 300);
  const GeometryQuery query{{kBeads, {x.data(), y.data(), z.data()}, r.data()}, first.data(), candidates.data(), 0};
  struct Found {
    std::vector<std::int32_t> bead = std::vector<std::int32_t>(4 * kBeads);
    std::vector<double> overlap = std::vector<double>(4 * kBeads), nx = overlap, ny = overlap, nz = overlap;
    std::vector<std::uint32_t> feature = std::vector<std::uint32_t>(4 * kBeads), triangle = feature, material = feature;
    GeometryContacts view() {
      return {4 * kBeads,     0, bead.data(), overlap.data(), {nx.data(), ny.data(), nz.data()}, feature.data(), triangle.data(),
              material.data()};
    }
    bool operator==(const Found&) const = default;
  };
  Found packs, singles;
  GeometryContacts a = packs.view(), b = singles.view();
  mill.contacts_by<Pack>(query, a);
  mill.contacts_by<double>(query, b);
  CHECK(a.count == touching);
  CHECK(b.count == a.count);
  CHECK(packs == singles);
}

TEST_CASE("Mills that cannot be built are refused with the remedy") {
  const auto refusal = [](const MillShape& shape) -> std::string {
    try {
      MillProfile profile(shape);
    } catch (const Refusal& e) {
      return e.what();
    }
    return "accepted";
  };
  MillShape shape = study();
  CHECK(refusal(shape) == "accepted");
  SECTION("too many") {
    shape.lifters = 60;
    CHECK_THAT(refusal(shape), Contains("overlap each other") && Contains("60"));
  }
  SECTION("too pointed") {
    shape.lifter_height = 0.02;
    CHECK_THAT(refusal(shape), Contains("meet below the top"));
  }
  SECTION("too high") {
    shape.lifter_height = 0.2;
    CHECK_THAT(refusal(shape), Contains("reaches the axis"));
  }
}

TEST_CASE("The report of the mill gives the volume of its lifters") {
  const Mill mill("mill", study(), 0.003, 1);
  // Trapezoid and the segment below it, 20 of them.
  CHECK_THAT(mill.report(), Contains("lifters: 20, height 0.005 m, width 0.02 m at the base and 0.0142265 m at the top"));
  const MillProfile profile(study());
  CHECK_THAT(profile.lifter_area(), WithinRel(20 * 0.5 * (0.0142265 + 0.02) * 0.005, 0.04));
  CHECK(mill.material_slots() == "shell|lifter|end");
  CHECK_THAT(mill.interior().radius, WithinAbs(0.15, 0));
}
