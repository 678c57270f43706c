// Standard errors of correlated series, and which windows are steady.
#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "kernel/run/statistics.hpp"
#include "millscope/random.hpp"

using millscope::Random;
using namespace millscope::run;

namespace {

double normal(Random& random) {
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// x_{k+1} = a x_k + noise, mean 5, standard deviation 1, integrated correlation time (1 + a)/(1 − a)/2.
std::vector<double> correlated_series(Random& random, std::size_t n, double a) {
  std::vector<double> x(n);
  double value = normal(random);
  for (double& v : x) {
    v = 5 + value;
    value = a * value + std::sqrt(1 - a * a) * normal(random);
  }
  return x;
}

}  // namespace

TEST_CASE("intervals of 90 % hold the true mean of a correlated series in 85 to 95 % of the cases") {
  for (const double a : {0.0, 0.8, 0.95}) {
    Random random(11);
    int hit = 0;
    double time = 0;
    for (int series = 0; series < 400; ++series) {
      const Mean m = correlated_mean(correlated_series(random, 1500, a));
      hit += std::abs(m.value - 5) < 1.645 * m.standard_error;
      time += m.correlation_time / 400;
    }
    INFO("a = " << a << ": " << hit / 4.0 << " % hit");
    CHECK(hit >= 340);
    CHECK(hit <= 380);
    CHECK(time == Approx(0.5 * (1 + a) / (1 - a)).epsilon(0.12));
  }
}

TEST_CASE("means of constant, tiny and alternating series") {
  const std::vector<double> constant(100, 3.0);
  CHECK(correlated_mean(constant).value == Approx(3));
  CHECK(correlated_mean(constant).standard_error == Approx(0).margin(1e-12));
  CHECK(std::isnan(correlated_mean(std::vector<double>{}).value));
  const std::vector<double> three{1, 2, 3};
  CHECK(correlated_mean(three).value == Approx(2));
  CHECK(std::isnan(correlated_mean(three).standard_error));
  std::vector<double> alternating;
  for (int k = 0; k < 100; ++k) alternating.push_back(k % 2);
  const Mean m = correlated_mean(alternating);
  CHECK(m.value == Approx(0.5));
  CHECK(m.standard_error == Approx(0.5 / 10));  // neighbours that undo each other: no more certain than independent ones
}

TEST_CASE("a drift is flagged, a stationary window is accepted") {
  Random random(3);
  int accepted = 0;
  std::map<double, int> flagged;
  for (int series = 0; series < 200; ++series) {
    std::vector<double> x = correlated_series(random, 1500, 0.8);
    for (double& v : x) v = 100 + v;  // the halves agree within the noise
    accepted += steadiness(x, 0.0).steady;
    for (const double drift : {1.0, 3.0, 100.0}) {  // a hundred hides no better than three
      std::vector<double> drifting = x;
      for (std::size_t k = 0; k < x.size(); ++k) drifting[k] += drift * static_cast<double>(k) / 1500;
      flagged[drift] += !steadiness(drifting, 0.0).steady;
    }
  }
  CHECK(accepted >= 192);
  CHECK(flagged[1.0] >= 100);
  CHECK(flagged[3.0] >= 198);
  CHECK(flagged[100.0] == 200);
  // A drift that no engineer would mind is accepted by the tolerance.
  std::vector<double> smooth;
  for (int k = 0; k < 1000; ++k) smooth.push_back(100 + 1e-3 * k);
  CHECK(!steadiness(smooth, 0.0).steady);
  CHECK(steadiness(smooth, 0.01).steady);
  CHECK(steadiness(smooth, 0.01).drift == Approx(0.5));
  CHECK(!steadiness(std::vector<double>(6, 1.0), 0.01).steady);  // too short to tell
}
