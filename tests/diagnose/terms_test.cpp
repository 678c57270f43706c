// Terms for the missing acceleration: the one that is there is offered with its strength, none where nothing or noise alone is missing.
#include "studies/diagnose/verdict/terms.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "kernel/base/random.hpp"

using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double kOmega = -6, kSem = 0.1;  // rad/s, m/s²

/// Cells of a mill whose beads rise with the shell outside and fall inside; `missing` gives what is added to both components.
template <class Missing>
std::vector<MissingForce> cells(std::uint64_t seed, Missing&& missing) {
  millscope::base::RandomStream random(seed);
  MissingForce m;
  m.omega = kOmega;
  for (int ring = 0; ring < 5; ++ring) {
    for (int sector = 0; sector < 12; ++sector) {
      const double radius = 0.03 * (ring + 0.5), angle = 2 * std::acos(-1.0) * sector / 12, slip = 1.6 * radius / 0.15 - 0.6;
      ForceCell c;
      c.place[0] = radius * std::sin(angle), c.place[1] = -radius * std::cos(angle);
      c.velocity[0] = -kOmega * slip * c.place[1] + 0.05 * random.normal();
      c.velocity[1] = kOmega * slip * c.place[0] + 0.05 * random.normal();
      const auto [x, y] = missing(c);
      const double value[] = {x + kSem * random.normal(), y + kSem * random.normal()};
      c.x = {value[0], value[0] - 1.645 * kSem, value[0] + 1.645 * kSem};
      c.y = {value[1], value[1] - 1.645 * kSem, value[1] + 1.645 * kSem};
      m.cells.push_back(c);
    }
  }
  return {m};
}

struct Push {
  double x, y;
};

}  // namespace

TEST_CASE("a drag that is missing is offered, with its coefficient") {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TermOffer offer = offer_terms(cells(seed, [](const ForceCell& c) { return Push{-2 * c.velocity[0], -2 * c.velocity[1]}; }));
    REQUIRE_FALSE(offer.terms.empty());
    CHECK(offer.terms[0].name == "linear drag");
    CHECK(offer.explained > 0.5);
    const millscope::base::Interval90& c = offer.terms[0].coefficient;
    if (offer.terms.size() == 1 && c.low <= 2 && 2 <= c.high) ++held;
    CHECK_THAT(c.value, WithinAbs(2, 0.3));
  }
  CHECK(held >= 14);  // 18 of 20 expected
}

TEST_CASE("two terms are told apart") {
  const TermOffer offer = offer_terms(cells(3, [](const ForceCell& c) { return Push{-2.5 * c.velocity[0], 1.0 - 1.2 * c.velocity[1]}; }));
  REQUIRE(offer.terms.size() == 2);
  std::vector<std::string> names{offer.terms[0].name, offer.terms[1].name};
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"linear drag", "uniform lift"});
  CHECK_THAT(sentence_of(offer), Contains("A hypothesis to test, not a finding") && Contains("linear drag (-c v)") && Contains("1/s"));
}

TEST_CASE("noise offers hardly ever a term") {
  int offered = 0;
  for (std::uint64_t seed = 100; seed < 200; ++seed)
    offered += offer_terms(cells(seed, [](const ForceCell&) { return Push{0, 0}; })).terms.empty() ? 0 : 1;
  CHECK(offered <= 15);
  CHECK_THAT(sentence_of(offer_terms(cells(100, [](const ForceCell&) { return Push{0, 0}; }))), Contains("none is offered"));
}

TEST_CASE("few cells are not looked at") {
  std::vector<MissingForce> few = cells(1, [](const ForceCell&) { return Push{0, 1}; });
  few[0].cells.resize(10);
  CHECK(offer_terms(few).terms.empty());
  CHECK_THAT(sentence_of(offer_terms(few)), Contains("10 cells are too few"));
  CHECK(offer_terms({}).terms.empty());
}
