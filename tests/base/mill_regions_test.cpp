#include "kernel/base/mill_regions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using namespace millscope::base;

namespace {

/// Edges of 30 cells across a mill of 0.3 m.
std::vector<double> edges() {
  std::vector<double> edges;
  for (int i = 0; i <= 30; ++i) edges.push_back(-0.15 + 0.01 * i);
  return edges;
}

}  // namespace

TEST_CASE("every cell of a map lies in one region") {
  std::vector<int> seen(900, 0);
  const auto regions = regions_of(edges(), edges(), {0.15, -1});
  CHECK(regions.size() == 24);
  for (const Region& region : regions) {
    for (const std::size_t cell : region.cells) ++seen[cell];
  }
  CHECK(std::count(seen.begin(), seen.end(), 1) == 900);
  CHECK(regions_of(edges(), edges(), {0.15, 0}).empty());
}

TEST_CASE("places are counted from 6 o'clock in the turning sense") {
  CHECK(place_in_mill(-0.105, 0.0, mill_place(0.15, -6)) == "0.70 R, 90° past 6 o'clock");
  CHECK(place_in_mill(0.105, 0.0, mill_place(0.15, 6)) == "0.70 R, 90° past 6 o'clock");
  CHECK(place_in_mill(0.075, -0.1299, mill_place(0.15, -6)) == "1.00 R, 30° before 6 o'clock");
  CHECK(place_in_mill(0.075, -0.1299, mill_place(0.15, 0)).empty());
}

TEST_CASE("the border of one region runs along its arcs and sides") {
  const MillPlace mill{0.15, 1};
  const auto regions = regions_of(edges(), edges(), mill);
  std::vector<bool> chosen(regions.size(), false);
  const auto middle =
      std::find_if(regions.begin(), regions.end(), [](const Region& r) { return r.name == "0.5–0.8 R, 0–45° past 6 o'clock"; });
  REQUIRE(middle != regions.end());
  chosen[middle - regions.begin()] = true;
  const auto lines = borders_of(regions, chosen, mill);
  CHECK(lines.size() == 4);
  for (const auto& line : lines) {
    for (const auto& [x, y] : line) {
      CHECK(std::hypot(x, y) > 0.4999 * 0.15);
      CHECK(std::hypot(x, y) < 0.8001 * 0.15);
      CHECK(x > -1e-9);  // 0 … 45° past 6 o'clock
      CHECK(-y > x - 1e-9);
    }
  }
}
