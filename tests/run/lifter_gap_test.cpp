// Gaps between lifters, measured on the surface.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dem/support.hpp"
#include "kernel/run/lifter_gap.hpp"

using namespace dem_test;
using Catch::WithinAbs;

namespace {

std::optional<double> gap_of(const std::string& geometry) {
  Setup s;
  s.geometry = geometry;
  const Assembly a = assembled(s);
  return run::narrowest_lifter_gap(a.geometries[0].surface, a.geometries[0].interior, 5e-3);
}

/// A wall along z above a closed line about the axis, as a mesh has it; m.
class Prism {
 public:
  explicit Prism(const std::vector<std::array<double, 2>>& corners) {
    for (const auto& [x, y] : corners) {
      for (const double z : {0.0, 0.02}) vertices_.insert(vertices_.end(), {x, y, z});
      radius_ = std::max(radius_, std::hypot(x, y));
    }
    const auto n = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % n);
      triangles_.insert(triangles_.end(), {a, a + 1, b, b, a + 1, b + 1});
    }
  }
  std::optional<double> gap(double bead_radius) const {
    const std::vector<std::uint32_t> materials(triangles_.size() / 3);
    const Surface surface{vertices_.size() / 3, vertices_.data(), triangles_.size() / 3, triangles_.data(), materials.data()};
    const Interior interior{1, 1, {0, 0, 0}, {0, 0, 1}, radius_, {-radius_, -radius_, 0}, {radius_, radius_, 0.02}};
    return run::narrowest_lifter_gap(surface, interior, bead_radius);
  }

 private:
  std::vector<double> vertices_;
  std::vector<std::uint32_t> triangles_;
  double radius_ = 0;
};

/// A round shell of 300 mm made of facets, with so many bars on it (0: none) of 20 mm that stand out by `height`.
std::vector<std::array<double, 2>> faceted(int facets, int bars = 0, double height = 0) {
  std::vector<std::array<double, 2>> line;
  const auto add = [&line](double r, double angle) { line.push_back({r * std::cos(angle), r * std::sin(angle)}); };
  const double turn = 2 * std::numbers::pi, half = std::asin(0.01 / 0.15);
  for (int k = 0; k < facets; ++k) {
    const double angle = turn * k / facets;
    const bool bar = bars > 0 && k % (facets / bars) == 0;
    if (!bar) add(0.15, angle);
    if (bar) {
      add(0.15, angle - half);
      add(0.15 - height, angle - half + 1e-3);
      add(0.15 - height, angle + half - 1e-3);
      add(0.15, angle + half);
    }
  }
  return line;
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

TEST_CASE("the facets of a round mesh are no lifters, however coarse it is") {
  for (const int facets : {6, 12, 24, 60}) {
    INFO(facets);
    CHECK_FALSE(Prism(faceted(facets)).gap(1e-3));
    CHECK_FALSE(Prism(faceted(facets)).gap(0.1));
  }
}

TEST_CASE("a mesh's lifters are found between its facets, unless a bead does not feel them") {
  const double wanted = 2 * 0.1459 * std::sin(std::numbers::pi / 8 - std::asin(0.01 / 0.15) + 0.5e-3);
  const Prism high(faceted(24, 8, 0.008)), low(faceted(48, 8, 0.0016));
  CHECK_THAT(high.gap(5e-3).value(), WithinAbs(wanted, 0.3e-3));
  CHECK(low.gap(5e-3));
  CHECK_FALSE(low.gap(10e-3));
}
