// Two-level plans where the truth is known by construction or from a textbook.
#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

// Montgomery 2013, example 6.2: filtration rate, an unreplicated 2^4 in standard order.
static const std::vector<double> kFiltration{45, 71, 48, 65, 68, 60, 80, 65, 43, 100, 45, 104, 75, 86, 70, 96};

TEST_CASE("effects of a textbook 2^4 plan, interactions included") {
  const Design d = two_level(factors(4), {}, 0);
  const Anova a = analyze_two_level(d, Eigen::Map<const Eigen::VectorXd>(kFiltration.data(), 16), TwoLevelModel::interactions);
  REQUIRE(a.effects.size() == 10);
  const double effect[] = {21.625, 3.125, 9.875, 14.625, 0.125, -18.125, 16.625, 2.375, -0.375, -1.125};
  for (std::size_t e = 0; e < 10; ++e) CHECK_THAT(a.effects[e].value, WithinAbs(effect[e], 1e-9));
  CHECK_THAT(a.effects[0].sum.value, WithinAbs(1870.56, 0.005));
  CHECK_THAT(a.total.value, WithinAbs(5730.94, 0.005));
  CHECK(a.residual.df == 5);
  CHECK_FALSE(a.curvature);
  CHECK(a.pure_error.df == 0);
}

TEST_CASE("main effects leave the interactions in the residual and show them") {
  const Design d = two_level(factors(4), {}, 0);
  const Anova a = analyze_two_level(d, Eigen::Map<const Eigen::VectorXd>(kFiltration.data(), 16));
  CHECK(a.residual.df == 11);
  double pooled = 0;
  for (const Effect& e : a.effects) pooled += e.pooled ? e.sum.value : 0;
  CHECK_THAT(pooled, WithinAbs(1314.06 + 1105.56 + 0.0625 + 22.5625 + 0.5625 + 5.0625, 0.01));
  CHECK(pooled < a.residual.value);
  CHECK(std::isnan(a.effects.back().sum.F));
}

TEST_CASE("replicates give pure error, lack of fit and the textbook F") {
  // Montgomery 2013, section 6.2: 2^2, three replicates.
  Design d = two_level(factors(2), {}, 0);
  const Eigen::MatrixXd once = d.coded;
  d.coded = once.replicate(3, 1);
  d.kind.assign(12, "factorial");
  Eigen::VectorXd y(12);
  y << 28, 36, 18, 31, 25, 32, 19, 30, 27, 32, 23, 29;
  const Anova a = analyze_two_level(d, y, TwoLevelModel::interactions);
  CHECK_THAT(a.effects[0].sum.value, WithinAbs(208.33, 0.005));
  CHECK_THAT(a.effects[1].sum.value, WithinAbs(75.00, 0.005));
  CHECK_THAT(a.effects[2].sum.value, WithinAbs(8.33, 0.005));
  CHECK_THAT(a.residual.value, WithinAbs(31.33, 0.005));
  CHECK_THAT(a.effects[0].sum.F, WithinAbs(53.19, 0.01));
  CHECK_THAT(a.effects[1].sum.p, WithinAbs(0.0024, 0.00005));
  CHECK_THAT(a.effects[2].sum.F, WithinAbs(2.13, 0.005));
  CHECK(a.pure_error.df == 8);
  CHECK(a.lack_of_fit.df == 0);
  CHECK_THAT(a.effects[0].standard_error, WithinAbs(std::sqrt(31.3333 / 8 / 3), 1e-4));  // of an effect: 2 σ/√12
}

TEST_CASE("curvature is what centre runs say against the corners") {
  const Design d = two_level(factors(2), {}, 5);
  Eigen::VectorXd y(9);
  y << 39.3, 40.9, 40.0, 41.5, 40.3, 40.5, 40.7, 40.2, 40.6;  // Montgomery 2013, example 6.6
  const Anova a = analyze_two_level(d, y, TwoLevelModel::interactions);
  REQUIRE(a.curvature);
  CHECK_THAT(a.curvature->value, WithinAbs(0.0027, 0.00005));
  CHECK_THAT(a.residual.value, WithinAbs(0.1720, 0.00005));
  CHECK_THAT(a.curvature->F, WithinAbs(0.063, 0.0005));
  CHECK_THAT(a.effects[0].sum.F, WithinAbs(55.87, 0.01));
}

TEST_CASE("the path of steepest descent follows the effects and keeps what has none") {
  const Design d = two_level(factors(3), {}, 0);
  const Anova a = analyze_two_level(d, 10 + (4 * d.coded.col(0) - 2 * d.coded.col(1)).array() + 1e-3 * d.coded.rowwise().prod().array());
  const auto path = steepest_descent(a, 0.5, 3);
  REQUIRE(path.size() == 4);
  CHECK(path[0].isZero());
  CHECK_THAT(path[1][0], WithinAbs(-0.5, 1e-12));
  CHECK_THAT(path[1][1], WithinAbs(0.25, 1e-12));
  CHECK_THAT(path[3][0], WithinAbs(-1.5, 1e-12));
  CHECK(path[3][2] == 0);
  CHECK(refusal([&] { steepest_descent(a, 0.5, 0); }).find("at least one step") != std::string::npos);
  Anova none = a;
  for (Effect& e : none.effects) e.sum.p = 0.9;
  CHECK(refusal([&] { steepest_descent(none, 0.5, 3, 0.1); }).find("no direction") != std::string::npos);
}

TEST_CASE("a lost run leaves a plan that can still be analysed, by partial sums") {
  const Design full = two_level(factors(3), {}, 3);
  Design d = full;
  d.coded = full.coded.bottomRows(10);
  d.kind.erase(d.kind.begin());
  Eigen::VectorXd y = 5 + (3 * d.coded.col(0) + d.coded.col(2)).array();
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] += i % 3 == 0 ? 0.1 : -0.05;
  const Anova a = analyze_two_level(d, y);
  CHECK_THAT(a.effects[0].value, WithinAbs(6, 0.2));
  REQUIRE_FALSE(a.notes.empty());
  CHECK(a.notes[0].find("no regular fraction") != std::string::npos);
}

TEST_CASE("a model that fits exactly leaves no error, and the report says so") {
  const Design d = two_level(factors(2), {}, 0);
  const Anova a = analyze_two_level(d, Eigen::Vector4d(1, 2, 3, 4));
  CHECK(std::isinf(a.effects[0].sum.F));
  REQUIRE(a.notes.size() == 1);
  CHECK(a.notes[0].find("fits exactly") != std::string::npos);
}

TEST_CASE("repeated runs that agree to the last digit measure no error") {
  const Design d = two_level(factors(2), {}, 3);
  Eigen::VectorXd y(7);
  y << 1, 2, 3, 5, 2.6, 2.6, 2.6;
  const Anova a = analyze_two_level(d, y);
  CHECK(std::isnan(a.lack_of_fit.F));
  REQUIRE_FALSE(a.notes.empty());
  CHECK(a.notes[0].find("agree to the last digit") != std::string::npos);
}
