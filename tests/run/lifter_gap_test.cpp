// Gaps between lifters, measured on the surface.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"
#include "kernel/run/lifter_gap.hpp"

using namespace dem_test;
using Catch::WithinAbs;

namespace {

std::optional<double> gap_of(const std::string& geometry) {
  Setup s;
  s.geometry = geometry;
  const Assembly a = assembled(s);
  return run::narrowest_lifter_gap(a.geometries[0].surface, a.geometries[0].interior);
}

std::string mill(int lifters, const std::string& more = "") {
  return "{liner: {kind: mill, diameter: 300 mm, length: 20 mm, lifters: " + std::to_string(lifters) +
         ", lifter_height: 6 mm, lifter_width: 20 mm, material: wall" + more + "}}";
}

}  // namespace

TEST_CASE("the gap between lifters is what the circle at half of their height has left") {
  for (const int lifters : {2, 8, 20}) {
    INFO(lifters);
    const double level = 0.147,
                 half = std::numbers::pi / lifters - std::asin(0.00813 / level);  // of the angle; a face at 60° is there at v = 8.13 mm
    const double wanted = 2 * level * std::sin(std::min(half, std::numbers::pi / 2));
    CHECK_THAT(gap_of(mill(lifters)).value(), WithinAbs(wanted, 0.3e-3));
  }
}

TEST_CASE("end faces and where lifters stand make no difference to the gap") {
  const double wanted = gap_of(mill(8)).value();
  CHECK_THAT(gap_of(mill(8, ", end_faces: true")).value(), WithinAbs(wanted, 0.3e-3));
  CHECK_THAT(gap_of(mill(8, ", phase: 17 deg")).value(), WithinAbs(wanted, 0.3e-3));
}

TEST_CASE("without two lifters there is no gap") {
  CHECK_FALSE(gap_of(mill(1)));
  CHECK_FALSE(gap_of("{drum: {kind: mill, diameter: 300 mm, length: 20 mm, lifters: 0, material: wall}}"));
  CHECK_FALSE(gap_of(kFloor));
}
