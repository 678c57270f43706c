#include <catch2/catch.hpp>

#include "analyzers/models/equations.hpp"
#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

namespace {

Outcome of_study(double fraction = 0.75, const std::string& options = "", AnalyzerContext context = study()) {
  context.omega *= fraction / 0.75;
  return Analyzer("models", context, options).of(all_beads(turning_disc(5, 0.1, 1), 5, {0.0, 0.1}, {0.1, 0.1}, context.omega));
}

}  // namespace

TEST_CASE("the study's mill at 75 %: critical speed, mass and the power models") {
  const Outcome o = of_study();
  CHECK(number(o, "critical_speed") * 30 / kPi == Approx(77.9).margin(0.05));
  CHECK(number(o, "critical_fraction") == Approx(0.75));
  CHECK(number(o, "mass_from_filling") == Approx(9.4).margin(0.05));
  CHECK(number(o, "filling_from_mass") == Approx(0.313));
  CHECK(number(o, "power_austin_concha") == Approx(28.8).margin(0.05));
  CHECK(number(o, "power_bond") == Approx(53.6).margin(0.05));
  CHECK(number(o, "power_morrell_overflow") == Approx(26.9).margin(0.05));
  CHECK(number(o, "power_morrell_grate") == Approx(30.6).margin(0.05));
}

TEST_CASE("a model says when the mill is out of its range") {
  const Outcome o = of_study();
  CHECK(number(o, "bond_in_range") == 0);
  CHECK_THAT(o.at("bond_in_range").doc, Catch::Contains("smaller than 2.4 m"));
  CHECK(number(o, "austin_concha_in_range") == 1);
  CHECK(number(o, "morrell_in_range") == 0);
  AnalyzerContext large = study();
  large.mill_radius = 2;
  large.mill_high = 6;
  large.bead_radius = 0.03;
  large.charge_mass = large.charge_count = 0;
  large.omega = 0.75 * 42.3 / std::sqrt(3.94) * kPi / 30;
  const Outcome big = of_study(0.75, "", large);
  CHECK(number(big, "bond_in_range") == 1);
  CHECK(number(big, "morrell_in_range") == 1);
  CHECK_THAT(of_study(0.97).at("morrell_in_range").doc, Catch::Contains("speed is above that of no power"));
  CHECK_THAT(of_study(1.2).at("austin_concha_in_range").doc, Catch::Contains("faster than critical"));
}

TEST_CASE("an empty mill draws nothing, and Morrell's power ends where it must") {
  using namespace millscope::analyzers::models;
  CHECK(bond(1, 1e-9, 0.75, 2500, 0.3, 0.27) < 1e-6);
  CHECK(bond(1, 0.2, 0.75, 2500, 0.3, 0.27) > bond(1, 0.1, 0.75, 2500, 0.3, 0.27));
  CHECK(austin_concha(9.4, 0.3, 0.3, 0.1) == Approx(0).margin(1e-12));
  // Morrell: at the limit the bracket leaves 0.954 − 0.135 J of the power, and at J = a nothing.
  CHECK(morrell(kGrate, 0.3, 0.27, 1575, morrell_a(0.75), 0.75) == Approx(0).margin(1e-12));
  CHECK(filling(mass(0.4, 2500, 0.02, 0.37), 2500, 0.02, 0.37) == Approx(0.4));
}

TEST_CASE("options stand for what a recording does not know, the rest is left out") {
  AnalyzerContext bare{};
  bare.mill_radius = 0.15;
  bare.bead_radius = 2.5e-3;
  bare.gravity = 9.81;
  bare.largest_id = 10;
  const Outcome least = of_study(0.75, "", bare);
  CHECK(least.count("critical_speed") == 1);
  CHECK(least.size() == 1);
  bare.omega = study().omega;
  bare.bead_density = 2500;
  const Outcome o = of_study(0.75, "filling=0.313 porosity=0.37 length=0.27", bare);
  CHECK(number(o, "power_austin_concha") == Approx(28.8).margin(0.05));
  CHECK(number(o, "power_morrell_grate") == Approx(30.6).margin(0.05));
  bare.mill_length = 0.27;  // known, though the end faces are not
  CHECK(number(of_study(0.75, "filling=0.313 porosity=0.37", bare), "power_morrell_grate") == Approx(30.6).margin(0.05));
  const Outcome no_porosity = of_study(0.75, "filling=0.313 length=0.27", bare);
  CHECK(no_porosity.count("power_bond") == 1);
  CHECK(no_porosity.count("power_morrell_grate") == 0);
  CHECK(no_porosity.count("power_austin_concha") == 0);
}
