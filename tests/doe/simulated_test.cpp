// Where the truth is known and drawn many times: tests hold their size, intervals and regions their confidence.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "millscope/observation_adapter.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/doe/stationary.hpp"
#include "support.hpp"

using namespace doe_test;

namespace {

constexpr int kScreenings = 2000, kSurfaces = 600, kFaulty = 150;

/// Of `repeats` with probability `p`, within four standard errors: one false alarm in 16 000.
bool plausible(int count, double p, int repeats) { return std::abs(count - repeats * p) < 4 * std::sqrt(repeats * p * (1 - p)); }

Eigen::VectorXd noise(Eigen::Index runs, millscope::Random& dice) {
  Eigen::VectorXd values(runs);
  for (double& v : values) v = dice.normal();
  return values;
}

Eigen::VectorXd bowl(const Design& d) {
  Eigen::VectorXd y(d.coded.rows());
  for (Eigen::Index run = 0; run < y.size(); ++run) {
    const double a = d.coded(run, 0), b = d.coded(run, 1);
    y[run] = 5 + 1.5 * a - b + 4 * a * a + 3 * b * b + a * b;
  }
  return y;
}

}  // namespace

TEST_CASE("screening: without effects, F, curvature and lack of fit each reject in one case of twenty") {
  const Design d = two_level(factors(4), {"D=A*B*C"}, 3);
  millscope::Random dice(11);
  int effect = 0, curvature = 0, lack = 0, covered = 0;
  for (int i = 0; i < kScreenings; ++i) {
    const Eigen::VectorXd y = 3 + (0.7 * d.coded.col(1) + noise(11, dice)).array();
    const Anova a = analyze_two_level(d, y);
    effect += a.effects[0].sum.p < 0.05 ? 1 : 0;
    curvature += a.curvature->p < 0.05 ? 1 : 0;
    lack += a.lack_of_fit.p < 0.05 ? 1 : 0;
    covered += std::abs(a.effects[1].value - 1.4) < t_quantile(0.05, a.residual.df) * a.effects[1].standard_error ? 1 : 0;
  }
  INFO(effect << " " << curvature << " " << lack << " " << covered << " of " << kScreenings);
  CHECK(plausible(effect, 0.05, kScreenings));
  CHECK(plausible(curvature, 0.05, kScreenings));
  CHECK(plausible(lack, 0.05, kScreenings));
  CHECK(plausible(covered, 0.95, kScreenings));
}

TEST_CASE("surface: coefficients are covered, tests hold their size, the region holds its stationary point") {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  const Eigen::VectorXd truth = bowl(d);
  const Eigen::Matrix2d form = (Eigen::Matrix2d() << 4, 0.5, 0.5, 3).finished();
  const Eigen::Vector2d place = -form.inverse() * Eigen::Vector2d(1.5, -1) / 2;
  const double truths[] = {5, 1.5, -1, 4, 3, 1};
  millscope::Random dice(12);
  int covered[6] = {}, lack = 0, in_region = 0;
  for (int i = 0; i < kSurfaces; ++i) {
    const Surface s = fit_surface(d, truth + 0.5 * noise(13, dice), 0.9);
    const double t = t_quantile(0.1, s.residual.df);
    for (std::size_t c = 0; c < 6; ++c)
      covered[c] += std::abs(s.coefficients[c].value - truths[c]) < t * s.coefficients[c].standard_error ? 1 : 0;
    lack += s.rejected ? 1 : 0;
    in_region += gradient_may_vanish(s, place) ? 1 : 0;
  }
  for (const int count : covered) CHECK(plausible(count, 0.9, kSurfaces));
  INFO(lack << " rejected, " << in_region << " of " << kSurfaces << " regions hold the truth");
  CHECK(plausible(lack, 0.1, kSurfaces));
  CHECK(plausible(in_region, 0.9, kSurfaces));
}

TEST_CASE("a faulty run is flagged, an honest one hardly ever") {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  const Eigen::VectorXd truth = bowl(d);
  millscope::Random dice(13);
  int found = 0, alarms = 0;
  for (int i = 0; i < kFaulty; ++i) {
    Eigen::VectorXd y = truth + 0.1 * noise(13, dice);
    for (const Residual& r : fit_surface(d, y).residuals) alarms += r.p < 0.05 ? 1 : 0;
    y[2] += 3;
    found += fit_surface(d, y).residuals[2].stands_out ? 1 : 0;
  }
  CHECK(found >= kFaulty - 2);
  CHECK(alarms <= 19);  // Bonferroni: one analysis in twenty has one; 7.5 expected, four standard errors above
}

TEST_CASE("the region's drawn extent is that of its members") {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  millscope::Random dice(14);
  const Surface s = fit_surface(d, bowl(d) + 0.5 * noise(13, dice));
  double low = 9, high = -9;
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 400; ++j) {
      const Eigen::Vector2d x = s.lower + (s.upper - s.lower).cwiseProduct(Eigen::Vector2d(i, j)) / 400;
      if (!gradient_may_vanish(s, x)) continue;
      low = std::min(low, x[0]);
      high = std::max(high, x[0]);
    }
  }
  CHECK(std::abs(s.stationary->region->low[0] - low) < 0.02);
  CHECK(std::abs(s.stationary->region->high[0] - high) < 0.02);
}
