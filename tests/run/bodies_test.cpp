// Geometries against the case: names of parts, the periodic domain, motions without a bound.
#include <catch2/catch.hpp>

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"

using namespace dem_test;

namespace {

using Catch::Contains;

/// A tube round z of 24 faces from `low` to `high`, m, with a radius at each end, as an STL file that is gone with the test.
class TubeFile {
 public:
  TubeFile(double low, double high, double radius_low = 0.05, double radius_high = 0.05) {
    std::ofstream file(path_);
    file << "solid tube\n";
    constexpr int kFaces = 24;
    for (int k = 0; k < kFaces; ++k) {
      const auto corner = [&](int side, bool upper) {
        const double angle = 2 * std::numbers::pi * (k + side) / kFaces, radius = upper ? radius_high : radius_low;
        return fmt::format("vertex {} {} {}\n", radius * std::cos(angle), radius * std::sin(angle), upper ? high : low);
      };
      for (const auto& triangle :
           {corner(0, false) + corner(0, true) + corner(1, true), corner(0, false) + corner(1, true) + corner(1, false)})
        file << "facet normal 0 0 0\nouter loop\n" << triangle << "endloop\nendfacet\n";
    }
    file << "endsolid tube\n";
  }
  ~TubeFile() { std::filesystem::remove(path_); }
  TubeFile(const TubeFile&) = delete;
  TubeFile& operator=(const TubeFile&) = delete;

  std::string mesh(const std::string& more) const {
    return fmt::format("{{liner: {{kind: mesh, file: {}, unit: m, material: wall{}}}}}", path_.string(), more);
  }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("millscope-tube-{}.stl", ::getpid());
};

Setup with(const std::string& geometry, const std::string& domain = "{low: [-1, -1, -1], high: [1, 1, 1]}") {
  Setup s;
  s.geometry = geometry;
  s.domain = domain;
  return s;
}

std::string periodic(double low_mm, double high_mm) { return fmt::format("{{periodic: {{z: [{} mm, {} mm]}}}}", low_mm, high_mm); }

std::string mill(const std::string& materials, double length_mm = 20) {
  return fmt::format(
      "{{drum: {{kind: mill, diameter: 100 mm, length: {} mm, lifters: 8, lifter_height: 8 mm, lifter_width: 20 mm, "
      "material: wall{}}}}}",
      length_mm, materials);
}

}  // namespace

TEST_CASE("a part that a geometry does not have is refused where it stands") {
  CHECK_NOTHROW(assembled(with(mill(", materials: {shell: wall, lifter: heavy}"), periodic(0, 20))));
  CHECK_THROWS_WITH(assembled(with(mill(", materials: {lifters: heavy, shell: wall}"), periodic(0, 20))),
                    Contains("test.yaml:") && Contains("'geometry.drum.materials.lifters'") && Contains("did you mean 'lifter'?"));
  CHECK_THROWS_WITH(assembled(with(mill(", materials: {top: heavy}"), periodic(0, 20))), Contains("known: shell, lifter"));
}

TEST_CASE("a mesh has the period of the domain") {
  const TubeFile tube(0, 0.02);
  CHECK_NOTHROW(assembled(with(tube.mesh(", period: 20 mm"), periodic(0, 20))));
  CHECK_NOTHROW(assembled(with(tube.mesh(", period: 20 mm"), periodic(-5, 15))));  // the copies cover it
  CHECK_THROWS_WITH(assembled(with(tube.mesh(", period: 20 mm"), periodic(0, 100))),
                    Contains("test.yaml:") && Contains("'geometry.liner.period' is 0.02 m") && Contains("0.1 m long"));
  CHECK_THROWS_WITH(assembled(with(tube.mesh(", period: 20 mm"))), Contains("not periodic along z"));
  CHECK_THROWS_WITH(assembled(with(tube.mesh(", period: 20 mm"), periodic(-12, 8))), Contains("translate: [0, 0, -0.012]"));
}

TEST_CASE("a mesh without a period covers the periodic domain") {
  const TubeFile tube(0, 0.02);
  CHECK_NOTHROW(assembled(with(tube.mesh(""), periodic(0, 20))));  // parallel to z: as if it went on
  CHECK_NOTHROW(assembled(with(tube.mesh(", scale: 2, translate: [0, 0, -10 mm]"), periodic(0, 20))));
  CHECK_THROWS_WITH(assembled(with(tube.mesh(""), periodic(0, 100))), Contains("covers z from 0 to 0.02 m") && Contains("[0, 0.1] m"));
  CHECK_THROWS_WITH(assembled(with(tube.mesh(""), periodic(-1, 20))), Contains("covers z from 0 to 0.02 m"));
  const TubeFile cone(0, 0.02, 0.05, 0.045);
  CHECK_THROWS_WITH(assembled(with(cone.mesh(""), periodic(0, 20))),
                    Contains("'geometry.liner' ends at z = 0 m") && Contains("period: 0.02 m"));
  CHECK_NOTHROW(assembled(with(cone.mesh(", period: 20 mm"), periodic(0, 20))));
}

TEST_CASE("a mill is as long as the periodic domain") {
  CHECK_THROWS_WITH(assembled(with(mill(""), periodic(0, 40))),
                    Contains("test.yaml:") && Contains("'geometry.drum' covers z from 0 to 0.02 m"));
  CHECK_NOTHROW(assembled(with(mill("", 40), periodic(0, 40))));
}

TEST_CASE("an endless plane turns about its own normal only") {
  const auto floor = [](const std::string& axis) {
    return "{floor: {kind: plane, point: [0, 0, 0], normal: [0, 1, 0], material: wall, motion: {rotation: {speed: 1 rad/s, axis: " + axis +
           "}}}}";
  };
  CHECK_NOTHROW(assembled(with(floor("[0, -2, 0]"))));
  CHECK_THROWS_WITH(assembled(with(floor("[0, 0, 1]"))), Contains("test.yaml:") && Contains("'geometry.floor' is endless"));
  CHECK_THROWS_WITH(assembled(with(floor("[0, 1, 0.001]"))), Contains("endless"));
}
