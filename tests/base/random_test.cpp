#include "millscope/random.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

using millscope::Random;

TEST_CASE("random bits are those of SplitMix64") {
  // Vigna's splitmix64.c with the seed 1234567 (Rosetta Code, "Pseudo-random numbers/Splitmix64").
  Random random(1234567);
  CHECK(random.bits() == 6457827717110365317ULL);
  CHECK(random.bits() == 3203168211198807973ULL);
  CHECK(random.bits() == 9817491932198370423ULL);
}

TEST_CASE("random numbers have the moments that they say") {
  constexpr int kDraws = 100000;
  Random random(1);
  double normal = 0, squared = 0, exponential = 0, between = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    normal += z / kDraws, squared += z * z / kDraws;
    exponential += random.exponential() / kDraws;
    between += random.between(2, 6) / kDraws;
  }
  // Four standard errors of each mean: 4/√n times the deviation (1, √2, 1, 4/√12).
  CHECK(std::abs(normal) < 0.013);
  CHECK(squared == Approx(1).margin(0.018));
  CHECK(exponential == Approx(1).margin(0.013));
  CHECK(between == Approx(4).margin(0.015));
}

TEST_CASE("a shuffle keeps what it shuffles, and puts every item everywhere") {
  constexpr int kItems = 4, kDraws = 24000;
  Random random(2);
  int at[kItems][kItems] = {};
  for (int i = 0; i < kDraws; ++i) {
    std::vector<int> items(kItems);
    std::iota(items.begin(), items.end(), 0);
    random.shuffle(items);
    for (int place = 0; place < kItems; ++place) ++at[items[place]][place];
  }
  for (const auto& places : at) {
    CHECK(std::accumulate(std::begin(places), std::end(places), 0) == kDraws);
    for (const int count : places) CHECK(count == Approx(kDraws / kItems).margin(4 * 67));  // √(n p (1 − p)) = 67
  }
}
