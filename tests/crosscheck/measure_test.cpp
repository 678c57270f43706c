#include "studies/crosscheck/measure.hpp"

#include <catch2/catch.hpp>

#include "kernel/base/random.hpp"

namespace millscope::crosscheck {
namespace {

output::FrameBeads beads_of(const std::vector<double>& radii) {
  output::FrameBeads beads;
  beads.radius = radii;
  for (std::size_t i = 0; i < radii.size(); ++i) beads.id.push_back(static_cast<std::uint32_t>(i)), beads.mass.push_back(1);
  return beads;
}

}  // namespace

TEST_CASE("beads that touch are counted, through a periodic end too") {
  // A chain along x of radii 1, 1, 2 where the first two and the last two overlap; a fourth lies beyond the end at z = 10 of the first.
  const output::FrameBeads beads = beads_of({1, 1, 2, 1});
  const std::vector<float> place{0, 0, 0.2F, 1.9F, 0, 0.2F, 4.8F, 0, 0.2F, 0, 0, 9.0F};
  CHECK(contacts_per_bead(place, beads, 0) == Approx(2 * 2 / 4.0));
  CHECK(contacts_per_bead(place, beads, 10) == Approx(2 * 3 / 4.0));
  CHECK(contacts_per_bead({}, beads_of({}), 0) == 0);
}

TEST_CASE("the count is that of every pair with every other") {
  base::RandomStream random(3);
  std::vector<double> radii;
  std::vector<float> place;
  for (int i = 0; i < 300; ++i) {
    radii.push_back(0.02 + 0.05 * random.uniform());
    for (int k = 0; k < 3; ++k) place.push_back(static_cast<float>(random.uniform()));
  }
  int touching = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        double d = std::fabs(static_cast<double>(place[3 * i + k]) - static_cast<double>(place[3 * j + k]));
        if (k == 2) d = std::min(d, 1 - d);
        square += d * d;
      }
      touching += square < (radii[i] + radii[j]) * (radii[i] + radii[j]);
    }
  }
  CHECK(contacts_per_bead(place, beads_of(radii), 1) == Approx(2.0 * touching / 300));
  CHECK(touching > 100);
}

TEST_CASE("what one run does not tell is left out of all by name") {
  std::vector<std::vector<Quantity>> runs{{{"a", "m", 1}, {"b", "m", 2}, {"c", "m", 3}},
                                          {{"a", "m", std::nan("")}, {"b", "m", 5}, {"d", "m", 6}}};
  CHECK(keep_common(runs) == std::vector<std::string>{"a", "c", "d"});
  for (const auto& run : runs) {
    REQUIRE(run.size() == 1);
    CHECK(run[0].name == "b");
  }
}

}  // namespace millscope::crosscheck
