#include "studies/analysis/times.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/support.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

analysis::BasicSeries series_of(const std::vector<double>& x, double step) {
  analysis::BasicSeries s;
  for (std::size_t i = 0; i < x.size(); ++i) {
    s.time.push_back(step * static_cast<double>(i));
    s.weight.push_back(step);
    for (auto& value : s.value) value.push_back(x[i]);
  }
  return s;
}

}  // namespace

TEST_CASE("the autocorrelation time of a known process, also with gaps and in several stretches") {
  constexpr double phi = 0.9, step = 0.01, truth = step * 0.5 * (1 + phi) / (1 - phi);
  const std::vector<double> x = autoregressive(40000, phi, 11);
  analysis::BasicSeries whole = series_of(x, step);
  CHECK_THAT(autocorrelation_time(analysis::even_series({whole}, 0)), WithinRel(truth, 0.1));
  analysis::BasicSeries holed;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 500 < 150) continue;  // a camera that loses its bead
    holed.time.push_back(whole.time[i]);
    holed.weight.push_back(step);
    for (auto& value : holed.value) value.push_back(x[i]);
  }
  CHECK_THAT(autocorrelation_time(analysis::even_series({holed}, 0)), WithinRel(truth, 0.15));
  const analysis::BasicSeries other = series_of(autoregressive(20000, phi, 12), step);
  CHECK_THAT(autocorrelation_time(analysis::even_series({whole, other}, 0)), WithinRel(truth, 0.15));
  CHECK(std::isnan(autocorrelation_time(analysis::even_series({series_of({1, 2, 3}, step)}, 0))));
}

TEST_CASE("long series are thinned without a change of their time") {
  constexpr double phi = 0.99, step = 0.001, truth = step * 0.5 * (1 + phi) / (1 - phi);
  const analysis::EvenSeries even = analysis::even_series({series_of(autoregressive(200000, phi, 4), step)}, 0, 20000);
  CHECK(even.rows[0].size() <= 20001);
  CHECK_THAT(autocorrelation_time(even), WithinRel(truth, 0.2));
}

TEST_CASE("the time of a circulation is that of a cycle, whatever the noise") {
  Random random(1);
  std::vector<double> x;
  for (int i = 0; i < 20000; ++i) x.push_back(std::sin(2 * 3.14159265358979 * i * 0.001 / 0.8) + 0.1 * random.normal());
  CHECK_THAT(analysis::circulation_time(analysis::even_series({series_of(x, 0.001)}, 0)), WithinRel(0.8, 0.01));
  // A camera that loses its bead after three quarters of each circulation never sees a whole one.
  analysis::BasicSeries torn, whole = series_of(x, 0.001);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 800 < 200) continue;
    torn.time.push_back(whole.time[i]);
    torn.weight.push_back(0.001);
    for (auto& value : torn.value) value.push_back(x[i]);
  }
  CHECK_THAT(analysis::circulation_time(analysis::even_series({torn}, 0)), WithinRel(0.8, 0.2));
  CHECK(analysis::circulation_time(analysis::even_series({series_of(std::vector<double>(100, 1.0), 0.001)}, 0)) == 0);
}

TEST_CASE("blocks are at least three transverse times and two circulations") {
  constexpr double step = 0.01;
  analysis::BasicSeries s = series_of(autoregressive(20000, 0.9, 8), step);
  s.value[3] = autoregressive(20000, 0.999, 9);  // z is slow and does not set the blocks
  const analysis::BlockRule many = analysis::block_rule({s}, false);
  CHECK_THAT(many.lengths.least, WithinRel(3 * 0.095, 0.3));
  REQUIRE(many.times.size() == 5);
  CHECK(many.times[3].name == "z");
  CHECK_FALSE(many.times[3].sets_the_block);
  CHECK(many.times[3].time > 3);
  CHECK_THAT(many.lengths.wished, WithinRel(3 * 0.095, 0.3));
  CHECK_THAT(many.times[0].effective, WithinRel(200 / (2 * 0.095), 0.2));
  for (std::size_t i = 0; i < s.size(); ++i) s.value[0][i] = std::sin(s.time[i] * 2 * 3.14159265358979 / 5);
  CHECK_THAT(analysis::block_rule({s}, true).lengths.least, WithinRel(10.0, 0.05));
}
