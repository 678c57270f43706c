// The two tables of Chagas 2015, worked again.
#include <catch2/catch.hpp>
#include <cmath>

#include "studies/doe/least_squares.hpp"
#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const Anova& anova_of(const TableAnalysis& a, std::size_t response) { return std::get<Anova>(a.results[response]); }
const Surface& surface_of(const TableAnalysis& a, std::size_t response) { return std::get<Surface>(a.results[response]); }

std::vector<std::string> standing_out(const TableAnalysis& a, const std::vector<Residual>& residuals) {
  std::vector<std::string> labels;
  for (std::size_t run = 0; run < residuals.size(); ++run) {
    if (residuals[run].stands_out) labels.push_back(a.table.labels[run]);
  }
  return labels;
}

}  // namespace

TEST_CASE("the screening table is recognised: factors, levels, generator, aliases") {
  const TableAnalysis a = published("factorial_75.csv");
  CHECK(a.table.kind == PlanKind::two_level);
  REQUIRE(a.table.design.factors.size() == 4);
  CHECK(a.table.design.factors[1].name == "CFPP");
  CHECK_THAT(a.table.design.factors[1].centre, WithinAbs(0.5, 1e-12));
  CHECK_THAT(a.table.design.factors[1].step, WithinAbs(0.2, 1e-12));
  CHECK(a.table.responses == std::vector<std::string>{"objective", "power_W"});
  CHECK(a.table.labels.front() == "1");
  CHECK(a.table.design.resolution == "IV");
  CHECK(a.table.generators == std::vector<std::string>{"CRPP*CFPP*CRPG*CFPG = +1"});
  CHECK(a.table.design.aliases == std::vector<std::string>{"CRPP*CFPP = CRPG*CFPG", "CRPP*CRPG = CFPP*CFPG", "CRPP*CFPG = CFPP*CRPG"});
  const Design plan = two_level(a.table.design.factors, {"CFPG=CRPP*CFPP*CRPG"}, 3);
  CHECK(plan.aliases == a.table.design.aliases);
  CHECK(plan.coded == a.table.design.coded);  // the study's runs stand in standard order
}

TEST_CASE("the screening table worked again: sums of squares and p by F(1,5)") {
  const TableAnalysis analysis = published("factorial_75.csv");
  const Anova& a = anova_of(analysis, 0);
  const double sums[] = {0.025, 1.163, 0.104, 0.007};
  const double p[] = {0.4264, 0.0020, 0.1405, 0.6767};
  const double F[] = {0.749, 34.40, 3.062, 0.196};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK_THAT(a.effects[i].sum.value, WithinAbs(sums[i], 0.0005));
    CHECK_THAT(a.effects[i].sum.F, WithinRel(F[i], 0.002));
    CHECK_THAT(a.effects[i].sum.p, WithinAbs(p[i], 0.00006));
    CHECK_FALSE(a.effects[i].pooled);
  }
  REQUIRE(a.curvature);
  CHECK_THAT(a.curvature->value, WithinAbs(0.116, 0.0005));
  CHECK_THAT(a.curvature->p, WithinAbs(0.1234, 0.00006));
  CHECK_THAT(a.total.value, WithinAbs(1.583, 0.0005));
  CHECK(a.total.df == 10);
  CHECK(a.residual.df == 5);
  CHECK_THAT(a.residual.value, WithinAbs(0.16900, 0.000005));
  CHECK(a.pure_error.df == 2);
  CHECK_THAT(a.pure_error.value, WithinAbs(0.031267, 0.0000005));
  CHECK_THAT(a.lack_of_fit.F, WithinAbs(2.937, 0.0005));
  CHECK_THAT(a.effects[1].value, WithinAbs(0.7625, 1e-9));  // the dominant factor
  CHECK_THAT(a.effects[1].sum.confidence(), WithinAbs(0.998, 0.0005));
}

TEST_CASE("p-values that follow from the study's printed F") {
  const double F[] = {33.95, 3.08, 0.73, 0.19, 3.32}, p[] = {0.0021, 0.140, 0.432, 0.681, 0.128};
  const double digits[] = {0.00005, 0.0005, 0.0005, 0.0005, 0.0005};
  for (int i = 0; i < 5; ++i) CHECK_THAT(f_beyond(F[i], 1, 5), WithinAbs(p[i], digits[i]));
}

TEST_CASE("the composite table is coded with axial runs at the square root of two") {
  const TableAnalysis a = published("ccd_75.csv");
  CHECK(a.table.kind == PlanKind::central_composite);
  const Design& d = a.table.design;
  CHECK_THAT(d.factors[0].centre, WithinAbs(0.30, 1e-12));
  CHECK_THAT(d.factors[0].step, WithinAbs(0.10, 1e-12));
  CHECK_THAT(d.factors[1].centre, WithinAbs(0.56, 1e-12));
  CHECK_THAT(d.factors[1].step, WithinAbs(0.03, 1e-12));
  CHECK_THAT(d.coded(4, 0), WithinAbs(-std::sqrt(2.0), 1e-12));
  CHECK_THAT(d.coded(7, 1), WithinAbs(std::sqrt(2.0), 1e-12));
  REQUIRE_FALSE(a.table.notes.empty());
  CHECK(a.table.notes[0].find("as written they stand at 1.333 to 1.4 steps") != std::string::npos);
  Choice literal;
  literal.axial = "as-written";
  const TableAnalysis written = published("ccd_75.csv", ModelChoice::automatic, literal);
  CHECK_THAT(written.table.design.coded(7, 1), WithinAbs(4.0 / 3, 1e-9));
  CHECK_THAT(written.table.design.coded(5, 0), WithinAbs(1.4, 1e-9));
}

TEST_CASE("the composite table worked again: coefficients, F, error, stationary point") {
  const TableAnalysis analysis = published("ccd_75.csv");
  const Surface& s = surface_of(analysis, 0);
  const double coefficient[] = {1.264, -0.384, 0.034, 0.587, 0.037, 0.0425}, digits[] = {0.0005, 0.0005, 0.0005, 0.0005, 0.0005, 0.00005};
  const double F[] = {0, 140.4, 1.11, 285.4, 1.16, 0.86};
  REQUIRE(s.coefficients.size() == 6);
  for (std::size_t c = 0; c < 6; ++c) CHECK_THAT(s.coefficients[c].value, WithinAbs(coefficient[c], digits[c]));
  for (std::size_t c = 1; c < 6; ++c) CHECK_THAT(s.coefficients[c].F, WithinAbs(F[c], F[c] > 10 ? 0.05 : 0.005));
  CHECK_THAT(s.residual.value, WithinAbs(0.0589, 0.00005));
  CHECK(s.residual.df == 7);
  REQUIRE(s.stationary);
  CHECK_THAT(s.stationary->natural[0], WithinAbs(0.335, 0.0005));
  CHECK_THAT(s.stationary->natural[1], WithinAbs(0.540, 0.0005));
  CHECK(s.stationary->kind == StationaryKind::minimum);
  CHECK(s.stationary->inside);
}

TEST_CASE("the composite table: the quadratic is rejected and the report says what follows") {
  const TableAnalysis analysis = published("ccd_75.csv");
  const Surface& s = surface_of(analysis, 0);
  CHECK(s.lack_of_fit.df == 3);
  CHECK(s.pure_error.df == 4);
  CHECK_THAT(s.pure_error.value, WithinAbs(0.00352, 0.000005));
  CHECK_THAT(s.lack_of_fit.F, WithinAbs(21.0, 0.05));
  CHECK_THAT(s.lack_of_fit.p, WithinAbs(0.007, 0.0005));
  CHECK(s.rejected);
  CHECK(s.lack_of_fit_sentence.find("lack of fit F(3,4) = 21.0") == 0);
  CHECK(s.lack_of_fit_sentence.find("rejected") != std::string::npos);
  CHECK(s.lack_of_fit_sentence.find("not to be trusted") != std::string::npos);
}

TEST_CASE("the composite table leaves the restitution undetermined and bounds the friction") {
  const TableAnalysis analysis = published("ccd_75.csv");
  const StationaryPoint& p = *surface_of(analysis, 0).stationary;
  CHECK(p.axes[0].flat);  // along CRPG
  CHECK(std::abs(p.axes[0].direction[1]) > 0.99);
  CHECK_FALSE(p.axes[1].flat);
  CHECK(p.sentence.find("along CRPG") != std::string::npos);
  REQUIRE(p.region);
  CHECK(p.region->bounded[0]);
  CHECK_FALSE(p.region->bounded[1]);
}

TEST_CASE("runs that stand out in the composite table: 13 and 17 on the objective, 14 on power") {
  const TableAnalysis a = published("ccd_75.csv");
  CHECK(standing_out(a, surface_of(a, 0).residuals) == std::vector<std::string>{"13", "17"});
  CHECK(standing_out(a, surface_of(a, 1).residuals) == std::vector<std::string>{"14"});
  CHECK(surface_of(a, 1).residuals[2].p < 0.001);  // beyond doubt, even among thirteen
  const std::string text = analysis_text(a);
  CHECK(text.find("  14     power_W") != std::string::npos);
  CHECK(text.find("  17   objective") != std::string::npos);
}
