#include "millscope/functions.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

using namespace millscope;

namespace {

/// Numbers of every size that the functions are for, and the borders between their pieces.
std::vector<double> positive_numbers() {
  std::vector<double> x{1e-300, 0.5, std::sqrt(0.5), 1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), std::sqrt(2.0), 2.0, 1e300};
  for (int k = -200; k <= 200; ++k) x.push_back(std::exp(0.37 * k));
  while (x.size() % kLanes != 0) x.push_back(3.0);
  return x;
}

/// Every lane has the bits of the double.
template <class F>
void check_same_bits(const std::vector<double>& x, F f) {
  for (std::size_t s = 0; s < x.size(); s += kPackWidth) {
    double packed[kPackWidth];
    store(packed, f(load<Pack>(&x[s])));
    for (int lane = 0; lane < kPackWidth; ++lane) {
      const double alone = f(x[s + static_cast<std::size_t>(lane)]);
      CHECK(std::memcmp(&packed[lane], &alone, sizeof alone) == 0);
    }
  }
}

}  // namespace

TEST_CASE("logarithm, exponential and power are those of the standard library") {
  for (const double x : positive_numbers()) {
    CAPTURE(x);
    CHECK(binary_logarithm(x) == Approx(std::log2(x)).epsilon(4e-16).margin(4e-16));
    CHECK(logarithm(x) == Approx(std::log(x)).epsilon(5e-16).margin(4e-16));
    CHECK(power(x, 0.687) == Approx(std::pow(x, 0.687)).epsilon(1e-15 * (1 + 0.687 * std::fabs(std::log2(x)))));
    CHECK(power(x, 1.0 / 3.0) == Approx(std::cbrt(x)).epsilon(1e-15 * (1 + std::fabs(std::log2(x)) / 3)));
  }
  for (double t = -700; t < 700; t += 0.731) {
    CAPTURE(t);
    CHECK(binary_power(t) == Approx(std::exp2(t)).epsilon(4e-16));
    CHECK(exponential(t) == Approx(std::exp(t)).epsilon(3e-16 * (1 + std::fabs(t))));
  }
  CHECK(binary_power(3.0) == 8.0);
  CHECK(binary_logarithm(8.0) == 3.0);
}

TEST_CASE("what they give at the ends of their ranges") {
  CHECK(power(0.0, 0.687) == 0.0);
  CHECK(exponential(0.0) == 1.0);
  CHECK(logarithm(1.0) == 0.0);
  CHECK(binary_logarithm(0.0) == -1022.0);
  CHECK(exponential(-1e6) == Approx(std::exp2(-1022)));
  CHECK(std::isfinite(exponential(1e6)));
  const double none = std::nan("");
  for (const double value : {binary_logarithm(none), binary_power(none), exponential(none), logarithm(none), power(none, 0.3)})
    CHECK(std::isnan(value));
  CHECK(std::isnan(lane_sum(power(Pack(none), 0.3))));
}

TEST_CASE("packs give the same bits as doubles") {
  const std::vector<double> x = positive_numbers();
  check_same_bits(x, [](auto a) { return binary_logarithm(a); });
  check_same_bits(x, [](auto a) { return power(a, 0.687); });
  check_same_bits(x, [](auto a) { return exponential(logarithm(a) * decltype(a)(-0.3)); });
}
