// Second-order surfaces where the truth is known by construction.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "millscope/observation_adapter.hpp"
#include "studies/doe/stationary.hpp"
#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// c + b·x + xᵀ B x with noise on a rotatable plan.
Surface surface(const Eigen::Vector2d& b, const Eigen::Matrix2d& B, double noise = 0.01, std::uint64_t seed = 5) {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  millscope::Random dice(seed);
  Eigen::VectorXd y(d.coded.rows());
  for (Eigen::Index run = 0; run < y.size(); ++run) {
    const Eigen::Vector2d x = d.coded.row(run).transpose();
    y[run] = 3 + b.dot(x) + x.dot(B * x) + noise * dice.normal();
  }
  return fit_surface(d, y);
}

const Eigen::Matrix2d kBowl = (Eigen::Matrix2d() << 1, 0.2, 0.2, 0.5).finished();

}  // namespace

TEST_CASE("a quadratic is found again, with its stationary point and kind") {
  const Eigen::Vector2d place(0.3, -0.4), b = -2 * kBowl * place;
  const Surface s = surface(b, kBowl);
  REQUIRE(s.stationary);
  CHECK(s.stationary->kind == StationaryKind::minimum);
  CHECK_THAT(s.stationary->coded[0], WithinAbs(0.3, 0.03));
  CHECK_THAT(s.stationary->coded[1], WithinAbs(-0.4, 0.03));
  CHECK(s.stationary->natural.isApprox(natural(s.factors, s.stationary->coded)));
  CHECK_FALSE(s.rejected);
  CHECK(s.r_squared > 0.999);
  REQUIRE(s.stationary->region);
  CHECK(s.stationary->region->bounded == std::vector<bool>{true, true});
  CHECK(s.stationary->region->low[0] < 0.3);
  CHECK(s.stationary->region->high[0] > 0.3);
  CHECK(s.stationary->region->high[0] - s.stationary->region->low[0] < 0.05);  // small, and still resolved
  CHECK(s.stationary->region->share > 0);
  CHECK(surface(-b, -kBowl).stationary->kind == StationaryKind::maximum);
  CHECK(surface(b, Eigen::Vector2d(1, -1).asDiagonal()).stationary->kind == StationaryKind::saddle);
}

TEST_CASE("a trough is a ridge, and the report says along what nothing is determined") {
  const Eigen::Matrix2d trough = (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  const Surface s = surface({0, 0}, trough);
  CHECK(s.stationary->kind == StationaryKind::ridge);
  CHECK(s.stationary->axes[0].flat);
  CHECK_FALSE(s.stationary->axes[1].flat);
  CHECK(s.stationary->sentence.find("0.71 A + 0.71 B") != std::string::npos);
  CHECK_FALSE(s.stationary->region->bounded[0]);
}

TEST_CASE("a noiseless trough and a plane") {
  const Surface trough = surface({0, 1}, Eigen::Vector2d(0, 1).asDiagonal(), 0);
  CHECK(trough.stationary->kind == StationaryKind::ridge);
  CHECK_THAT(trough.stationary->coded[0], WithinAbs(0, 1e-6));
  CHECK_THAT(trough.stationary->coded[1], WithinAbs(-0.5, 1e-6));
  CHECK_FALSE(surface({1, 1}, Eigen::Matrix2d::Zero(), 0).stationary);
}

TEST_CASE("partial and sequential sums of squares agree where terms are orthogonal and add up where not") {
  const Surface s = surface({1, -2}, kBowl, 0.3, 5);
  double sequential = 0;
  for (std::size_t c = 1; c < s.coefficients.size(); ++c) sequential += s.coefficients[c].sequential;
  CHECK_THAT(sequential, WithinRel(s.model.value, 1e-9));
  CHECK_THAT(s.model.value + s.residual.value, WithinRel(s.total.value, 1e-12));
  CHECK_THAT(s.coefficients[1].partial, WithinRel(s.coefficients[1].sequential, 1e-9));
  CHECK(std::abs(s.coefficients[3].partial / s.coefficients[3].sequential - 1) > 1e-6);
  CHECK_THAT(s.coefficients[5].F, WithinRel(std::pow(s.coefficients[5].value / s.coefficients[5].standard_error, 2), 1e-9));
  CHECK_THAT(s.lack_of_fit.value + s.pure_error.value, WithinRel(s.residual.value, 1e-12));
}

TEST_CASE("a kink is found as lack of fit") {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  millscope::Random dice(3);
  Eigen::VectorXd y(13);
  for (Eigen::Index run = 0; run < 13; ++run) y[run] = std::abs(d.coded(run, 0) - 0.3) + 0.02 * dice.normal();
  const Surface s = fit_surface(d, y);
  CHECK(s.rejected);
  CHECK(s.lack_of_fit.p < 0.01);
}

TEST_CASE("the externally studentised residual is that of a fit without the run") {
  Surface s = surface({1, 0}, kBowl, 0.2, 9);
  const Design d = central_composite(factors(2), rotatable(2), 5);
  millscope::Random dice(9);
  Eigen::VectorXd y(13);
  for (Eigen::Index run = 0; run < 13; ++run) {
    const Eigen::Vector2d x = d.coded.row(run).transpose();
    y[run] = 3 + x[0] + x.dot(kBowl * x) + 0.2 * dice.normal();
  }
  const Eigen::Index out = 6;
  Design less = d;
  less.coded.resize(12, 2);
  less.coded << d.coded.topRows(out), d.coded.bottomRows(12 - out);
  Eigen::VectorXd rest(12);
  rest << y.head(out), y.tail(12 - out);
  const Surface without = fit_surface(less, rest);
  const Eigen::VectorXd x = d.coded.row(out).transpose();
  const double scale = std::sqrt(without.residual.mean_square() + std::pow(standard_error_at(without, x), 2));
  CHECK_THAT(s.residuals[out].studentised, WithinRel((y[out] - value_at(without, x)) / scale, 1e-9));
}

TEST_CASE("the least value in a box: inside, on an edge, in a corner, of a saddle") {
  const Eigen::Vector2d low(-1, -1), high(1, 1);
  CHECK(least_within(surface({0, 0}, kBowl, 0), low, high).isZero(1e-9));
  const Eigen::VectorXd edge = least_within(surface(-2 * kBowl * Eigen::Vector2d(2, 0), kBowl, 0), low, high);
  CHECK(edge[0] == 1);
  CHECK_THAT(edge[1], WithinAbs(0.4, 1e-9));  // where 0.4 + 0.5 · 2 y = 0.4 · 2
  CHECK(least_within(surface({0.1, 0.1}, -kBowl, 0), low, high) == Eigen::Vector2d(-1, -1));
  const Eigen::VectorXd saddle = least_within(surface({0.1, 0}, Eigen::Vector2d(-1, 1).asDiagonal(), 0), low, high);
  CHECK(saddle[0] == -1);
  CHECK_THAT(saddle[1], WithinAbs(0, 1e-9));
  CHECK(refusal([&] { least_within(surface({0, 0}, kBowl), high, low); }).find("upper end") != std::string::npos);
}

TEST_CASE("slopes are the derivatives of the terms") {
  const Surface s = surface({1, 2}, kBowl);
  const Eigen::Vector2d x(0.3, -0.8);
  const double h = 1e-6;
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(i);
    const Eigen::VectorXd numeric = (terms_at(s.coefficients, x + step) - terms_at(s.coefficients, x - step)) / (2 * h);
    CHECK(slopes_at(s.coefficients, x).row(i).transpose().isApprox(numeric, 1e-8));
  }
}
