#include <catch2/catch.hpp>
#include <cmath>

#include "kernel/base/statistics.hpp"

using millscope::base::Interval90;
using millscope::base::kNormal90;

TEST_CASE("a normal law lies within the 90 % interval in nine of ten cases") {
  CHECK(std::erf(kNormal90 / std::sqrt(2.0)) == Approx(0.9).epsilon(1e-15));
  const Interval90 interval = Interval90::about(3, 0.5);
  CHECK(interval.value == 3);
  CHECK(interval.high - interval.low == Approx(2 * 0.5 * kNormal90).epsilon(1e-15));
  CHECK(interval.standard_error() == Approx(0.5).epsilon(1e-15));
}

TEST_CASE("an interval holds its ends, and is known where both are") {
  const Interval90 interval{2, 1, 4};
  CHECK((interval.holds(1) && interval.holds(4)));
  CHECK_FALSE((interval.holds(0.99) || interval.holds(4.01)));
  CHECK(interval.known());
  CHECK_FALSE(Interval90{2, 1, INFINITY}.known());
  CHECK_FALSE(Interval90{2, std::nan(""), 3}.known());
}
