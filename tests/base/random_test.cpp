#include "millscope/random.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
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

TEST_CASE("normal numbers by layers are normal everywhere, the tail too, and independent of each other") {
  constexpr int kDraws = 4000000;
  Random random(5);
  double mean = 0, square = 0, product = 0, fourth = 0, beyond_two = 0, last = random.normal_by_layers();
  std::vector<double> bins(162);  // a twentieth wide from −4 to 4, and what lies beyond
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal_by_layers();
    mean += z / kDraws, square += z * z / kDraws, product += z * last / kDraws, fourth += z * z * z * z / kDraws;
    beyond_two += (std::abs(z) > 2) / static_cast<double>(kDraws);
    last = z;
    ++bins[static_cast<std::size_t>(std::clamp(20 * z + 81, 0.0, 161.0))];
  }
  // Four standard errors: of the mean and of the product of neighbours 4/√n, of the square 4 √(2/n), of the fourth power 4 √(96/n).
  CHECK(std::abs(mean) < 0.002);
  CHECK(std::abs(product) < 0.002);
  CHECK(square == Approx(1).margin(0.0028));
  CHECK(beyond_two == Approx(0.0455).margin(0.00042));
  CHECK(fourth == Approx(3).margin(0.02));
  const auto below = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  double chi_squared = 0;
  for (int k = 0; k < 162; ++k) {
    const double low = k == 0 ? 0 : below(0.05 * (k - 81)), high = k == 161 ? 1 : below(0.05 * (k - 80));
    const double expected = kDraws * (high - low), off = bins[static_cast<std::size_t>(k)] - expected;
    chi_squared += off * off / expected;
  }
  CHECK(chi_squared == Approx(161).margin(4 * 18));  // 161 degrees of freedom: deviation √(2·161) = 18
  CHECK(bins[0] + bins[161] == Approx(kDraws * 2 * below(-4)).margin(4 * 16));
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
