// The score's arithmetic on diagnoses that were made up, against numbers worked out by hand.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "studies/challenge/page.hpp"

using namespace millscope::challenge;
using Catch::WithinAbs;

namespace {

TrueEffect rolling(double strength) { return {"rolling", strength, "mu_r", 0.2 * strength, 0, 0.2}; }
TrueEffect bridge(double strength) { return {"bridge", strength, "gamma", 10 * strength, 0, 10}; }

Answer answer(const std::string& set, Kind kind, std::vector<TrueEffect> effects = {}) {
  return {set, kind, kind == Kind::outside ? "soft" : "", std::move(effects), {{"friction", 0.3}}, {}};
}

Found found(const std::string& verdict, std::vector<std::string> named) {
  Found f;
  f.verdict = verdict;
  f.named = std::move(named);
  return f;
}

/// A value whose interval was not worked out.
millscope::base::Interval90 open(double value) { return {value, std::nan(""), std::nan("")}; }

/// λ of an effect that is linear in its strength.
std::vector<std::pair<double, double>> square_law(double full) { return {{0, 0}, {0.25, full / 16}, {1, full}}; }

/// Ten sets: three with nothing, one of them rightly; four with one effect, one of which failed; two at once; one outside; one to come.
std::vector<Marked> ten_sets() {
  Found right = found("no_mismatch", {});
  right.hypotheses = {{"rolling", "not needed", square_law(80), open(0.02)}};
  right.retuned = {{"friction", {0.3, 0.28, 0.32}}};
  Found alarm = found("named", {"rolling"});
  alarm.retuned = {{"friction", {0.15, 0.1, 0.2}}};
  Found rejected = found("outside_library", {});
  rejected.retuned = {{"friction", {0.1, 0.1, 0.1}}};
  Found named = found("named", {"rolling"});
  named.hypotheses = {{"rolling", "best", square_law(80), millscope::base::Interval90{0.11, 0.09, 0.13}},
                      {"bridge", "rejected", square_law(10), open(1)}};
  named.retuned = {{"friction", {0.4, 0.38, 0.42}}};
  named.unmasked = {{"friction", {0.32, 0.31, 0.35}}};
  named.gains = {{"slow", "retuned to power", {1.5, 0.5, 2.5}}};
  Found ambiguous = found("ambiguous", {"bridge", "rolling"});
  ambiguous.hypotheses = {{"rolling", "not rejected", square_law(80), open(0.17)},
                          {"bridge", "best", square_law(10), millscope::base::Interval90{9, 8, 10}}};
  Found missed = found("no_mismatch", {});
  missed.hypotheses = {{"bridge", "not needed", square_law(10), open(1)}};
  Found half = found("named", {"rolling"});
  half.hypotheses = {{"rolling", "best", square_law(40), open(0.1)}};
  Found failed;
  failed.failure = "no camera";
  return {{answer("s1", Kind::none), right},
          {answer("s2", Kind::none), alarm},
          {answer("s3", Kind::none), rejected},
          {answer("s4", Kind::effect, {rolling(0.5)}), named},
          {answer("s5", Kind::effect, {rolling(1)}), ambiguous},
          {answer("s6", Kind::effect, {bridge(0.4)}), missed},
          {answer("s7", Kind::two, {rolling(0.5), bridge(0.5)}), half},
          {answer("s8", Kind::outside), found("outside_library", {})},
          {answer("s9", Kind::effect, {rolling(0.7)}), failed},
          {answer("s10", Kind::none), std::nullopt}};
}

void check(const Count& count, int hits, int of) {
  CHECK(count.hits == hits);
  CHECK(count.of == of);
}

}  // namespace

TEST_CASE("bounds of Clopper and Pearson") {
  CHECK_THAT(upper_bound({0, 59}, 0.95), WithinAbs(1 - std::pow(0.05, 1.0 / 59), 1e-9));
  CHECK(upper_bound({0, 59}, 0.95) < 0.05);
  CHECK_THAT(lower_bound({59, 59}, 0.95), WithinAbs(std::pow(0.05, 1.0 / 59), 1e-9));
  CHECK_THAT(upper_bound({1, 2}, 0.95), WithinAbs(std::sqrt(0.95), 1e-9));
  CHECK_THAT(lower_bound({1, 2}, 0.95), WithinAbs(1 - std::sqrt(0.95), 1e-9));
  CHECK(upper_bound({3, 3}, 0.95) == 1);
  CHECK(lower_bound({0, 3}, 0.95) == 0);
  CHECK(upper_bound({}, 0.95) == 1);
}

TEST_CASE("an exact test of a count, and Holm's of several") {
  CHECK_THAT(binomial_p({0, 2}, 0.9), WithinAbs(0.01, 1e-12));
  CHECK_THAT(binomial_p({1, 2}, 0.9), WithinAbs(0.19, 1e-12));
  CHECK_THAT(binomial_p({2, 2}, 0.9), WithinAbs(1, 1e-12));
  CHECK_THAT(binomial_p({0, 3}, 0.5), WithinAbs(0.25, 1e-12));  // both tails
  CHECK(binomial_p({}, 0.9) == 1);
  const std::vector<double> p = millscope::base::holm({0.01, 0.04, 0.03, 0.9});
  CHECK_THAT(p[0], WithinAbs(0.04, 1e-12));
  CHECK_THAT(p[1], WithinAbs(0.09, 1e-12));  // not below that of the smaller 0.03
  CHECK_THAT(p[2], WithinAbs(0.09, 1e-12));
  CHECK_THAT(p[3], WithinAbs(0.9, 1e-12));
}

TEST_CASE("even numbers are neither low nor high, heaped ones are what they are") {
  std::vector<double> even, high, low;
  for (int i = 0; i < 40; ++i) even.push_back((i + 0.5) / 40), high.push_back(0.5 + (i + 0.5) / 80), low.push_back((i + 0.5) / 80);
  CHECK(low_p(even) > 0.95);
  CHECK(high_p(even) > 0.95);
  CHECK((low_p(high) > 0.95 && high_p(high) < 1e-6));
  CHECK((low_p(low) < 1e-6 && high_p(low) > 0.95));
  CHECK(low_p({}) == 1);
  // Of 100 numbers the one-sided distance 0.1208 is that of 5 %: √(−ln 0.05 / 2) / (10 + 0.12 + 0.011).
  std::vector<double> edge;
  for (int i = 0; i < 100; ++i) edge.push_back(std::max(0.0, (i + 1) / 100.0 - 0.1208));
  CHECK(low_p(edge) == Approx(0.05).epsilon(0.01));
}

TEST_CASE("the ideal test's power and the λ that it needs") {
  CHECK(ideal_power(0, 0.01) == Approx(0.01));
  CHECK(ideal_power(telling_lambda(0.01), 0.01) == Approx(0.8));
  CHECK(telling_lambda(0.05) == Approx(6.18).epsilon(1e-3));  // (1.645 + 0.842)²
  Found f = found("no_mismatch", {});
  f.level = 0.05;
  f.hypotheses = {{"rolling", "", square_law(1), {}}, {"friction", "", {{-1, 4}, {0, 0}, {1, 4}}, {}}, {"other", "", square_law(1), {}}};
  f.hypotheses[2].tested = false;
  CHECK(f.level_of(f.hypotheses[0]) == Approx(0.025));
  CHECK(f.level_of(f.hypotheses[1]) == Approx(0.0125));
}

TEST_CASE("a false second effect is no class of two, and a class is not both") {
  Found two = found("named", {"bridge", "rolling"}), either = two;
  two.together = true;
  const Score one_hidden = score({{answer("s1", Kind::effect, {rolling(1)}), two}, {answer("s2", Kind::effect, {rolling(1)}), either}});
  check(one_hidden.in_class, 2, 2);
  check(one_hidden.in_class_of_two, 1, 2);
  const Score two_hidden =
      score({{answer("s1", Kind::two, {rolling(1), bridge(1)}), two}, {answer("s2", Kind::two, {rolling(1), bridge(1)}), either}});
  check(two_hidden.two_both, 1, 2);
  check(two_hidden.two_class, 2, 2);
  CHECK(label_of(two) == "named: bridge + rolling");
  CHECK(Marked{answer("s", Kind::effect, {rolling(1)}), two}.missed());
}

TEST_CASE("what is a miss") {
  const auto missed = [](Kind kind, const Found& f) { return Marked{answer("s", kind), f}.missed(); };
  Found filling = found("named", {"filling"}), failed;
  filling.hypotheses = {{"filling", "best", {}, {}, false}};
  failed.failure = "no camera";
  CHECK((missed(Kind::none, filling) && !missed(Kind::none, found("undetectable", {}))));
  CHECK((missed(Kind::outside, found("no_mismatch", {})) && !missed(Kind::outside, found("outside_library", {}))));
  CHECK((!missed(Kind::decoy, filling) && missed(Kind::decoy, found("outside_library", {})) &&
         missed(Kind::decoy, found("named", {"rolling"}))));
  CHECK((missed(Kind::none, failed) && missed(Kind::decoy, failed)));
}

TEST_CASE("a slope's interval holds the slope, and shrinks with the scatter") {
  std::vector<std::pair<double, double>> tight, wide;
  for (int i = 0; i < 20; ++i) {
    const double x = i / 20.0, push = i % 2 == 0 ? 1 : -1;
    tight.emplace_back(x, x + 0.01 * push), wide.emplace_back(x, x + 0.1 * push);
  }
  const Line a = line_through(tight), b = line_through(wide);
  CHECK((a.slope_low < 1 && 1 < a.slope_high && b.slope_low < 1 && 1 < b.slope_high));
  // ±1.96 σ/√Sxx, with Sxx = n (n² − 1)/12 of steps of a twentieth.
  CHECK(b.slope_high - b.slope_low == Approx(2 * 1.96 * 0.1 / std::sqrt(20 * 399 / 12.0 / 400)).epsilon(0.15));
  CHECK(a.slope_high - a.slope_low == Approx((b.slope_high - b.slope_low) / 10).epsilon(0.01));
  CHECK(std::isnan(line_through({{0, 0}, {1, 1}, {2, 2}}).slope_low));
  for (const double x : {1.0, 0.1, 0.7}) {  // an effect that is on or off
    const Line none = line_through({{x, 1}, {x, 2}, {x, 3}, {x, 4}, {x, 5}, {x, 6}, {x, 7}});
    CHECK((std::isnan(none.slope) && std::isnan(none.slope_low)));
  }
}

TEST_CASE("hits, misses and abstentions are counted") {
  const Score s = score(ten_sets());
  CHECK(s.sets == 10);
  CHECK(s.diagnosed == 9);
  CHECK(s.failed == 1);
  check(s.false_alarms, 2, 3);
  check(s.false_names, 1, 3);
  check(s.named_alone, 1, 4);
  check(s.best_right, 1, 4);
  check(s.in_class, 2, 4);
  check(s.in_class_of_two, 2, 4);
  check(s.abstained_on_effect, 0, 3);  // of one that failed it is not known
  CHECK(s.mean_class == 1.5);
  check(s.two_both, 0, 1);
  check(s.two_one, 1, 1);
  check(s.outside_abstained, 1, 1);
  check(s.outside_named, 0, 1);
  check(s.outside_missed, 0, 1);
}

TEST_CASE("a faint effect asks that no physics be named but itself") {
  const auto diagnosed = [](double lambda, std::vector<std::string> named) {
    Found f = found("ambiguous", std::move(named));
    f.hypotheses = {{"rolling", "not needed", square_law(lambda), open(0.1)},
                    {"bridge", "best", square_law(50), open(0.1)},
                    {"filling", "best", {}, open(0.3), false}};
    return Marked{answer("s", Kind::effect, {rolling(1)}), f};
  };
  check(score({diagnosed(9, {})}).faint_nothing_else, 1, 1);
  check(score({diagnosed(9, {"rolling"})}).faint_nothing_else, 1, 1);
  check(score({diagnosed(9, {"filling", "rolling"})}).faint_nothing_else, 1, 1);
  check(score({diagnosed(9, {"bridge"})}).faint_nothing_else, 0, 1);
  check(score({diagnosed(9, {"bridge", "rolling"})}).faint_nothing_else, 0, 1);
  check(score({diagnosed(11, {"bridge"})}).faint_nothing_else, 0, 0);
}

TEST_CASE("a line leaves out what is faint, beside that through all") {
  std::vector<Marked> sets;
  for (int k = 1; k <= 6; ++k) {
    const double strength = 0.15 * k;
    const bool faint = k == 6;
    Found f = found("named", {"rolling"});
    f.hypotheses = {{"rolling", "best", square_law(faint ? 5 : 1000), open(faint ? 0 : 0.2 * strength)}};
    sets.push_back({answer("s", Kind::effect, {rolling(strength)}), f});
  }
  const Score s = score(sets);
  CHECK(s.line_of_clear.points == 5);
  CHECK(s.line_of_clear.slope == Approx(1));
  CHECK(s.line.points == 6);
  CHECK(s.line.slope < 0.6);
}

TEST_CASE("a decoy goes wrong where physics is named, and not where what was believed is") {
  Found filling = found("named", {"filling"});
  filling.hypotheses = {{"filling", "best", {}, {}, false}};
  const Score s = score({{answer("s1", Kind::decoy), filling},
                         {answer("s2", Kind::decoy), found("named", {"rolling"})},
                         {answer("s3", Kind::decoy), found("no_mismatch", {})}});
  check(s.decoys_named, 1, 3);
  check(s.false_alarms, 0, 0);
}

TEST_CASE("strengths, parameters, power and gains") {
  const Score s = score(ten_sets());
  REQUIRE(s.coverage.size() == 2);  // in order of their names: friction, strength
  CHECK(s.coverage[0].truth == 0.3);
  CHECK(std::isnan(s.coverage[0].p));
  check(s.coverage[0].inside, 1, 4);  // one of them has its whole interval at an end of the range
  check(s.coverage[1].inside, 1, 1);
  CHECK(s.coverage[1].p == Approx(1));
  REQUIRE(s.recovery.size() == 1);
  CHECK_THAT(s.recovery[0].retuned, WithinAbs(0.1, 1e-12));
  CHECK_THAT(s.recovery[0].unmasked, WithinAbs(0.02, 1e-12));
  REQUIRE(s.estimates.size() == 3);  // 0.5 → 0.55, 1 → 0.85, 0.4 → 0.1
  CHECK_THAT(s.line.slope, WithinAbs(0.645 / 0.62, 1e-9));
  CHECK_THAT(s.line.intercept, WithinAbs((1.5 - 1.9 * 0.645 / 0.62) / 3, 1e-9));
  CHECK((!s.estimates[0].faint && !s.estimates[1].faint && s.estimates[2].faint));  // λ 20, 80, 1.6
  REQUIRE(s.at_zero.size() == 1);
  CHECK_THAT(s.at_zero[0], WithinAbs(0.1, 1e-12));
  check(s.power[0].named, 0, 1);  // λ 1.6
  check(s.power[1].named, 0, 0);
  check(s.power[2].named, 1, 1);  // λ 20; that of two effects does not count
  check(s.power[3].named, 1, 1);  // λ 80
  REQUIRE(s.gains.size() == 1);
  check(s.gains[0].surely, 1, 1);
  CHECK(s.gains[0].median == 1.5);
}

TEST_CASE("lambda at a strength lies between those of the diagnosis, its root evenly") {
  const Tested bent{"wear", "best", {{-1, 36}, {0, 0}, {0.5, 16}, {1, 25}}, {}};
  CHECK(bent.lambda(0.5) == Approx(16));
  CHECK(bent.lambda(0.25) == Approx(4));
  CHECK(bent.lambda(0.75) == Approx(20.25));
  CHECK(bent.lambda(-0.5) == Approx(9));
  CHECK(bent.lambda(1) == Approx(25));
  CHECK(std::isnan(Tested{}.lambda(0.5)));  // nothing is known of it
}

TEST_CASE("an effect that lies beyond the level is told by a longer recording, and a miss may carry its reason") {
  std::vector<Marked> sets = ten_sets();
  sets[5].remark = "too faint";
  sets[5].found->level = 0.05;
  const Score s = score(sets);
  const std::string text = page_text({sets, s, "", {{"sets", "cafe"}}});
  CHECK(text.find("| s6 | bridge | 0.40 | 0.10 | 2 | 3.9 × | no_mismatch |") != std::string::npos);  // (1.645 + 0.842)² / 1.6
  CHECK(text.find("| s6 | bridge | 2 | no_mismatch | too faint |") != std::string::npos);
  CHECK(text.find("| s7 | rolling + bridge | 10 | named: rolling | not looked into |") != std::string::npos);
  CHECK(text.find("| s4 | rolling | 20 | named") == std::string::npos);
}

TEST_CASE("a parameter that a challenge gives all of its sets is one trial, also where two challenges are counted together") {
  std::vector<Marked> sets = ten_sets();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    sets[i].answer.theta = {{"friction", 0.3 + 0.01 * static_cast<double>(i)}, {"stiffness", i < 2 ? 0.02 : 0.03}};
    if (sets[i].found) sets[i].found->retuned["stiffness"] = {0.02, 0.01, 0.03};
  }
  const Score s = score(sets);
  for (const Coverage& c : s.coverage) {
    INFO(c.of);
    CHECK(c.truth.has_value() == (c.of == "stiffness"));
  }
  const std::string text = page_text({sets, s, "", {{"sets", "cafe"}}});
  CHECK(text.find("| stiffness, truth 0.02 |  | 2 of 2") != std::string::npos);  // each truth is a trial of its own
  CHECK(text.find("| one truth: one trial |") != std::string::npos);
}

TEST_CASE("sets of two mills, engines and programs are counted apart") {
  std::vector<Marked> sets = ten_sets();
  sets[1].answer.made = {{"fast", {{"settings", {"a=1", "run.engine=liggghts"}}}}};
  sets[2].answer.made = {{"fast", {{"settings", {"a=1"}}}}};
  sets[3].study = "other";
  sets[4].program = "c3dc7bf";
  sets[1].found->base_p = 0.96;
  sets[1].found->base_q = 0.6;
  sets[1].found->hypotheses = {{"rolling", "best", {}, {}, true, true, 0.7}};
  Answer camera = answer("s11", Kind::decoy), clock = answer("s12", Kind::decoy);
  camera.name = "camera", clock.name = "clock";
  sets.push_back({camera, found("no_mismatch", {})});
  sets.push_back({clock, found("outside_library", {})});
  const std::vector<Group> groups = groups_of(sets);
  REQUIRE(groups.size() == 5);            // those that tell nothing of how they were made are of no engine
  CHECK(groups[1].engine == "liggghts");  // in the order of the sets
  CHECK(groups[4].program == "c3dc7bf");
  const std::string text = page_text({sets, score(sets), "", {{"sets", "cafe"}}});
  CHECK(text.find("| liggghts |  |  | 1 of 1 |") != std::string::npos);
  CHECK(text.find("| millscope |  |  | 0 of 1 |") != std::string::npos);
  CHECK(text.find("|  | c3dc7bf |  |  |  |  | 1 of 1 | 0 of 1 |  |  |  |") != std::string::npos);  // λ 80, in a class of two
  CHECK(text.find("|  |  |  |  |  | 1 of 1 |  | 1 of 1 |  |  |  |") != std::string::npos);         // λ 20, named
  CHECK(text.find("|  |  |  | 0 of 1 | 0 of 1 |  |  | 0 of 2 | 0 of 1 | 1 of 1 | 1 of 2 |") != std::string::npos);
  const auto told = [](double p) { return fmt::format("{:.2f} | {:.2g} | {:.2g}", p, low_p({p}), high_p({p})); };
  CHECK(text.find(fmt::format("| liggghts |  |  | 1 | {} | {} | 0.60 |  |", told(0.96), told(0.7))) != std::string::npos);
  CHECK(text.find("|  |  | all of this engine | 0 of 1 |") != std::string::npos);
  CHECK(text.find("| liggghts |  | all of this engine |") == std::string::npos);  // its one group says it already
}

TEST_CASE("what a diagnosis says is right, right in part, or wrong") {
  std::vector<Marked> sets = ten_sets();
  Found seven = found("ambiguous", {"filling", "rolling", "bridge"}), pool = found("ambiguous", {"rolling"});
  seven.hypotheses = {{"filling", "best", {}, {}, false}, {"rolling", "not rejected", {}, {}}, {"bridge", "not rejected", {}, {}}};
  sets.push_back({answer("s11", Kind::decoy), seven});
  sets.push_back({answer("s12", Kind::decoy), pool});
  const Score s = score(sets);
  std::map<std::string, std::vector<int>> said;
  for (const Said& one : s.said) said[one.what] = {one.right, one.part, one.wrong};
  CHECK(said.at("named") == std::vector<int>{1, 1, 1});  // s4; one of two in s7; an alarm in s2
  CHECK(said.at("ambiguous: a list of two and more") == std::vector<int>{1, 1, 0});
  CHECK(said.at("ambiguous: one listed, not confirmed by a held-out condition") == std::vector<int>{0, 0, 1});
  CHECK(said.at("no_mismatch") == std::vector<int>{1, 0, 1});
  CHECK(said.at("outside_library") == std::vector<int>{1, 0, 1});
  CHECK(said.at("nothing: it failed") == std::vector<int>{0, 0, 1});
}

TEST_CASE("the held-out power's error stands beside that of sets with nothing hidden") {
  std::vector<Marked> sets = ten_sets();
  sets[0].found->power = {{"retuned to power", 0.5}}, sets[1].found->power = {{"retuned to power", 1.5}};
  sets[3].found->power = {{"retuned to power", 4}, {"corrected", 0.25}};  // rolling is best, and true
  sets[4].found->power = {{"corrected", 9}};                              // bridge is best
  const Score s = score(sets);
  REQUIRE(s.held_out_power.size() == 2);
  CHECK(s.held_out_power[0].model == "corrected");
  CHECK((s.held_out_power[0].effect == 0.25 && s.held_out_power[0].effects == 1 && s.held_out_power[0].empties == 0));
  CHECK((s.held_out_power[1].effect == 4 && s.held_out_power[1].empty == 1 && s.held_out_power[1].empties == 2));
}

TEST_CASE("every diagnosed set stands in the confusion matrix once") {
  const Score s = score(ten_sets());
  int sum = 0;
  for (const auto& row : s.confusion) {
    for (const int count : row) sum += count;
  }
  CHECK(sum == 9);
  CHECK(s.truths == std::vector<std::string>{"bridge", "none", "outside: soft", "rolling", "rolling + bridge"});
  CHECK(s.answers == std::vector<std::string>{"ambiguous: bridge, rolling", "failed", "named: rolling", "no_mismatch", "outside_library"});
  CHECK(s.confusion[3] == std::vector<int>{1, 1, 1, 0, 0});
}

TEST_CASE("the page says what was missed") {
  const std::vector<Marked> sets = ten_sets();
  const Score s = score(sets);
  const std::string text = page_text({sets, s, "millscope challenge score sets", {{"sets", "cafe"}}});
  for (const char* part : {"physics is named or listed in 1 of 3", "missing in 2 of 3", "`cafe`", "    millscope challenge score sets",
                           "| s9 | rolling | 0.70 |  |  |  | failed: no camera |", "| s6 | bridge | 0.40 | 0.10 | 2 |  | no_mismatch |",
                           "| s10 | none |  |  |  |  | not diagnosed yet |", "1 of 4 (25 %",
                           "faint (λ below 10): no physics is listed but the truth | 1 of 1"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
  const auto json = score_json({sets, s, "", {{"sets", "cafe"}}});
  CHECK(json.at("top_1").at("hits") == 1);
  CHECK(json.at("faint_nothing_else").at("of") == 1);
  CHECK(json.at("strengths").at("estimates").at(2).at("faint") == true);
}

TEST_CASE("a score of nothing is said to be one") {
  const Score s = score({});
  CHECK(s.false_alarms.of == 0);
  CHECK(std::isnan(s.line.slope));
  CHECK(page_text({{}, s, "", {{"sets", ""}}}).find("none tried") != std::string::npos);
}
