// Where a prediction of the surrogate may be relied on, and which rivals may be the strongest.
#include "studies/diagnose/verdict/judge.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace millscope;
using namespace millscope::diagnose;
using Catch::WithinRel;
using Eigen::Vector2d;

namespace {

const MatrixXd kNoise = Vector2d(4, 1).asDiagonal();  // standard deviations 2 and 1

/// Two left-out runs whose deviations have this root mean square in each observable.
MatrixXd runs(double first, double second) { return (MatrixXd(2, 2) << first, second, -first, second).finished(); }

}  // namespace

TEST_CASE("a prediction is relied on below half of the difference that is judged, and not at it") {
  const Vector2d difference(6, 0);  // three noise units
  CHECK_THAT(reliance(difference, kNoise, {runs(2.9, 0)}).difference, WithinRel(3.0));
  CHECK_THAT(reliance(difference, kNoise, {runs(2.9, 0)}).error, WithinRel(1.45));
  CHECK(reliance(difference, kNoise, {runs(2.9, 0)}).enough());
  CHECK_FALSE(reliance(difference, kNoise, {runs(3.0, 0)}).enough());
  CHECK_FALSE(reliance(0.5 * difference, kNoise, {runs(2.9, 0)}).enough());
}

TEST_CASE("only what the surrogate gets wrong along the difference counts") {
  CHECK_THAT(reliance(Vector2d(6, 0), kNoise, {runs(1, 100)}).error, WithinRel(0.5));
  CHECK_FALSE(reliance(Vector2d(6, 3), kNoise, {runs(1, 100)}).enough());
}

TEST_CASE("the runs that the surrogate errs most for count: those with the candidate, or those without") {
  CHECK_THAT(reliance(Vector2d(6, 0), kNoise, {runs(1, 0), runs(3, 0)}).error, WithinRel(1.5));
  CHECK_THAT(reliance(Vector2d(6, 0), kNoise, {runs(3, 0), runs(1, 0)}).error, WithinRel(1.5));
}

TEST_CASE("without left-out runs, or without a difference, nothing is relied on") {
  CHECK_FALSE(reliance(Vector2d(6, 0), kNoise, {runs(1, 0), MatrixXd()}).enough());
  CHECK_FALSE(reliance(Vector2d(0, 0), kNoise, {runs(0, 0)}).enough());
}

TEST_CASE("rivals within two errors of the strongest may be the strongest, those beyond may not") {
  const auto about = [](double value, double error) { return base::Interval90::about(value, error); };
  // The strongest is the second; errors of a difference are √(0.3² + 0.4²) = 0.5 and √(0.3² + 0.1²) = 0.316.
  CHECK(near_strongest({about(1.99, 0.4), about(1, 0.3), about(2.01, 0.4), about(1.64, 0.1), about(1.62, 0.1)}) ==
        std::vector<std::size_t>{0, 1, 4});
  CHECK(near_strongest({about(-3, 0.1)}) == std::vector<std::size_t>{0});
  CHECK(near_strongest({}).empty());
}
