// Which numbers of a run give cause to doubt it, and which do not.
#include <catch2/catch.hpp>

#include <cmath>

#include "kernel/run/doubts.hpp"

using namespace millscope::run;
using Catch::Contains;

namespace {

/// A run of which nothing is doubted: six turns, and errors that are smaller than whatever is doubted.
Soundness sound() {
  Soundness s;
  s.deepest = {{"glass~glass", false, 0.03}, {"glass~steel (wall)", true, 0.049}};
  s.stiffness_factor = 0.001;
  s.contact_steps = 20;
  s.turn = 0.8;
  s.window = 4.8;
  s.drift = {1.2, 0.004};
  s.imbalance = 0.003;
  s.power_error = 1e-5;
  s.centre_error = 1e-7;
  s.bead_radius = 5e-3;
  s.gap = LifterGap{"liner", 0.03};
  return s;
}

/// The one doubt of `s`.
Doubt only(const Soundness& s) {
  const std::vector<Doubt> doubts = doubts_of(s);
  REQUIRE(doubts.size() == 1);
  CHECK_FALSE(doubts[0].finding.empty());
  CHECK_FALSE(doubts[0].may_change.empty());
  CHECK_FALSE(doubts[0].remedy.empty());
  return doubts[0];
}

}  // namespace

TEST_CASE("a sound run has no doubt") { CHECK(doubts_of(sound()).empty()); }

TEST_CASE("beads that sink in by more than a twentieth of their radius are told with their pair") {
  Soundness s = sound();
  s.deepest[1].overlap = 0.2;
  const Doubt d = only(s);
  CHECK(d.name == "overlap");
  CHECK(d.of == "glass~steel (wall)");
  CHECK(d.value == 0.2);
  CHECK(d.limit == 0.05);
  CHECK(d.unit == "bead radii");
  CHECK_THAT(d.finding, Contains("glass~steel (wall)") && Contains("20 %") && Contains("5 %"));
  CHECK_THAT(d.may_change, Contains("0.6 mm") && Contains("0.8 %"));                  // by the wall; by the beads it were 0.4 mm and 0.5 %
  CHECK(d.remedy == "raise stiffness_factor to 0.032, at about 5.7 times the time");  // 4^(5/2), Hertz, and its root
  s.deepest[0].overlap = 0.3;
  CHECK(only(s).of == "glass~glass");  // the deepest alone: one remedy serves all
  CHECK_THAT(only(s).finding, Contains("beads overlap by up to 30 %"));
  s.turn = 0;
  CHECK_THAT(only(s).may_change, !Contains("power"));
}

TEST_CASE("no body is made stiffer than it is, and no factor is named that changes nothing") {
  Soundness s = sound();
  s.deepest[1].overlap = 0.2;
  s.stiffness_factor = 0.25;
  CHECK(only(s).remedy == "raise stiffness_factor to 1.0, at about 2.0 times the time");
  s.stiffness_factor = 1;  // a soft liner, foam
  CHECK(doubts_of(s).empty());
  s.stiffness_from_young = false;
  CHECK_THAT(only(s).remedy, Contains("give the contact law a higher stiffness") && !Contains("raise"));
}

TEST_CASE("a number beside its limit is told with the digits that tell it from the limit, and none as a power of ten") {
  Soundness s = sound();
  s.contact_steps = 9.996;
  CHECK(only(s).finding == "the shortest contact lasts 9.996 time steps, under 10");
  s.contact_steps = 0.04;
  CHECK(only(s).finding == "the shortest contact lasts 0.040 time steps, under 10");
  s = sound();
  s.deepest[1].overlap = 0.05004;
  CHECK_THAT(only(s).finding, Contains("by up to 5.004 % of their radius, over 5 %"));
  s.deepest[1].overlap = 0.6;
  s.bead_radius = 0.05;
  s.gap = {};
  CHECK(only(s).may_change == "the charge may lie some 20 mm too low, its power be off by 2 %, and fitted friction be off");
  s = sound();
  s.window = 1.592;
  CHECK_THAT(only(s).finding, Contains("over 1.99 turns of the mill, under 2"));
  s.steady = false;
  s.window = 4.8;
  s.drift = {3.001, 0.01002};
  CHECK_THAT(only(s).finding, Contains("by 3.001 of its standard errors, over 3, and by 1.002 % of itself, over 1 %"));
}

TEST_CASE("an overlap that moves neither power nor centre by their own errors is not told") {
  Soundness s = sound();
  s.deepest[1].overlap = 0.06;
  CHECK(doubts_of(s).size() == 1);
  s.power_error = s.centre_error = 0.05;
  CHECK(doubts_of(s).empty());
  s.power_error = s.centre_error = 0;  // not known
  CHECK(doubts_of(s).size() == 1);
}

TEST_CASE("contacts of fewer than ten steps are told") {
  Soundness s = sound();
  s.contact_steps = 10;
  CHECK(doubts_of(s).empty());
  s.contact_steps = 9.4;
  const Doubt d = only(s);
  CHECK(d.name == "contact_steps");
  CHECK(d.value == 9.4);
  CHECK_THAT(d.finding, Contains("9.4"));
  CHECK_THAT(d.may_change, Contains("0.30 %"));
  s.power_error = 0.004;
  CHECK(doubts_of(s).empty());
  s.contact_steps = 5.9;  // so few that the book may close by chance alone
  CHECK(only(s).name == "contact_steps");
  s.imbalance = {};  // walls do no work
  s.contact_steps = 9;
  CHECK(only(s).may_change == "impacts lose other energies than the law says");
  s.contact_steps = {};  // nothing has touched
  CHECK(doubts_of(s).empty());
}

TEST_CASE("energy that nothing accounts for is told, whether a run makes it or loses it") {
  Soundness s = sound();
  s.unaccounted = 0.1;
  CHECK(doubts_of(s).empty());
  s.unaccounted = 0.93;
  const Doubt d = only(s);
  CHECK(d.name == "energy");
  CHECK(d.finding == "93 % of the energy that goes through is not accounted for, over 10 %");
  CHECK_THAT(d.remedy, Contains("time.step_fraction"));
}

TEST_CASE("a window of less than two turns is told, of a mill that turns") {
  Soundness s = sound();
  s.window = 1.6;
  CHECK(doubts_of(s).empty());
  s.window = 1.6 - 0.9e-3;  // the last sample is not at the very end
  CHECK(doubts_of(s).empty());
  s.window = 1.2;
  const Doubt d = only(s);
  CHECK(d.name == "short_window");
  CHECK(d.value == Approx(1.5));
  CHECK_THAT(d.remedy, Contains("0.40 s"));
  s.window = {};
  CHECK(only(s).value == 0);
  CHECK(only(s).finding == "the analysis window is too short for any mean");
  CHECK_THAT(only(s).remedy, Contains("1.6 s"));
  s.turn = 0;
  CHECK(doubts_of(s).empty());
}

TEST_CASE("a mill that is not steady is told") {
  Soundness s = sound();
  s.steady = false;
  s.drift = {5.5, 0.031};
  const Doubt d = only(s);
  CHECK(d.name == "not_steady");
  CHECK(d.value == 5.5);
  CHECK(d.limit == 3);
  CHECK_THAT(d.finding, Contains("5.5 of its standard errors, over 3") && Contains("3.1 % of itself, over 1 %"));
}

TEST_CASE("a bead that fills more than half of a lifter's gap is told, with the body") {
  Soundness s = sound();
  s.gap->width = 0.0201;
  CHECK(doubts_of(s).empty());
  s.gap->width = 0.0125;
  const Doubt d = only(s);
  CHECK(d.name == "lifter_gap");
  CHECK(d.of == "liner");
  CHECK(d.value == Approx(0.8));
  CHECK_THAT(d.finding, Contains("12.5 mm"));
  s.gap = {};
  CHECK(doubts_of(s).empty());
}

TEST_CASE("doubts come back from a summary as they were, and from one of before there were any as none") {
  Soundness s = sound();
  s.contact_steps = 5;
  s.window = 0.4;
  const std::vector<Doubt> doubts = doubts_of(s);
  nlohmann::ordered_json summary;
  summary["doubts"] = doubts;
  const std::vector<Doubt> read = doubts_in(nlohmann::ordered_json::parse(summary.dump()));
  REQUIRE(read.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(read[i].name == doubts[i].name);
    CHECK(read[i].value == doubts[i].value);
    CHECK(sentence_of(read[i]) == sentence_of(doubts[i]));
  }
  summary["doubts"][1]["value"] = nullptr;  // infinity in a file
  CHECK(std::isinf(doubts_in(summary)[1].value));
  CHECK(doubts_in({{"steady", true}}).empty());
  CHECK(doubts_in(nullptr).empty());
}
