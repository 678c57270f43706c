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

TEST_CASE("two normal numbers are normal, and independent of each other") {
  constexpr int kDraws = 100000;
  Random random(5);
  double mean = 0, product = 0, squares[2] = {}, fourth = 0, beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto [a, b] = random.normals();
    mean += (a + b) / (2 * kDraws), product += a * b / kDraws;
    squares[0] += a * a / kDraws, squares[1] += b * b / kDraws;
    fourth += (a * a * a * a + b * b * b * b) / (2 * kDraws);
    beyond_two += (std::abs(a) > 2) / static_cast<double>(kDraws);
  }
  // Four standard errors: of the means 4/√n (two as many: 4/√(2n)), of the squares 4 √(2/n), of the fourth power 4 √(96/(2n)).
  CHECK(std::abs(mean) < 0.009);
  CHECK(std::abs(product) < 0.013);
  CHECK(squares[0] == Approx(1).margin(0.018));
  CHECK(squares[1] == Approx(1).margin(0.018));
  CHECK(fourth == Approx(3).margin(0.088));
  CHECK(beyond_two == Approx(0.0455).margin(0.0027));
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
