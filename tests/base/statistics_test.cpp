#include "kernel/base/statistics.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace millscope::base;

TEST_CASE("quantiles of one set by each rule") {
  std::vector<double> v{7, 3, 9, 1, 5, 11};  // ranks 0 … 5: 1 3 5 7 9 11
  CHECK(quantile(v, 0.5) == 7);              // rank 2.5, upwards
  CHECK(quantile(v, 0.7) == 9);              // 3.5, upwards
  CHECK(quantile(v, 0.66) == 7);             // 3.3
  CHECK(quantile(v, 0) == 1);
  CHECK(quantile(v, 1) == 11);
  CHECK(quantile_below(v, 0.5) == 5);
  CHECK(quantile_below(v, 0.99) == 9);
  CHECK(quantile_below(v, 1) == 11);
  CHECK(quantile_of_next(v, 0.5) == 7);   // the fourth: 4/7 of further draws lie below it, 3/7 below the third
  CHECK(quantile_of_next(v, 0.9) == 11);  // the seventh of six
  const std::vector<double> sorted{1, 3, 5, 7, 9, 11};
  CHECK(interpolated_quantile(sorted, 0.5) == 6);
  CHECK(interpolated_quantile(sorted, 0.05) == 1.5);
  CHECK(interpolated_quantile(sorted, 1) == 11);
}

TEST_CASE("quantiles of a single value are that value") {
  std::vector<double> one{4};
  for (const double fraction : {0.0, 0.3, 1.0}) {
    CHECK(quantile(one, fraction) == 4);
    CHECK(quantile_below(one, fraction) == 4);
    CHECK(quantile_of_next(one, 0.9) == 4);
    CHECK(interpolated_quantile(one, fraction) == 4);
  }
}

TEST_CASE("a quantile by weight") {
  CHECK(weighted_quantile({{3, 1}, {1, 1}, {2, 8}}, 0.5) == 2);
  CHECK(weighted_quantile({{3, 9}, {1, 1}, {2, 1}}, 0.5) == 3);
  CHECK(weighted_quantile({{1, 0}, {2, 1}}, 0) == 2);
  CHECK(std::isnan(weighted_quantile({}, 0.5)));
}
