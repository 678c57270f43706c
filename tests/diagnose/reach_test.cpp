// Ranges that are too narrow: what the bank adds, and what is said of it.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "kernel/base/random.hpp"
#include "made_up_diagnosis.hpp"
#include "studies/diagnose/bank/bank_status.hpp"
#include "studies/diagnose/bank/beyond.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::WithinAbs;
using Catch::Matchers::Contains;
using naming::Judged;
using testing::Scratch;

TEST_CASE("beyond an end of a range a bank has simulations in the strip that follows, and keeps all others") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  const Index rolling = Index{0};
  const End friction{.coordinate = 0, .upper = true}, strength{.candidate = rolling, .upper = true};
  CHECK(place_of(q, friction) == 0.6);
  CHECK(farthest_of(q, friction) == Approx(0.85));
  CHECK(farthest_of(q, {.coordinate = 0, .upper = false}) > 0);  // no friction is below 0
  CHECK(farthest_of(q, strength) == 2);
  std::set<double> values;
  for (const BankPoint& p : plan_beyond(q, friction)) {
    CHECK(p.group == "base>bead_friction");
    CHECK(p.active.empty());
    CHECK(p.theta[0] >= 0.6);
    CHECK(p.theta[0] <= 0.85);
    values.insert(p.theta[0]);
  }
  CHECK(values.size() == static_cast<std::size_t>((q.bank.base + 2) / 3));
  const std::vector<BankPoint> stronger = plan_beyond(q, strength);
  CHECK(std::ssize(stronger) == (q.bank.each + 1) / 2);
  for (const BankPoint& p : stronger) {
    CHECK(p.group == "rolling_resistance>");
    CHECK(p.active.front().strength > 1.05);
    CHECK(p.active.front().strength <= 2);
  }
  const Question wider = widened(widened(q, friction), strength);
  CHECK(wider.study.parameters[0].high == Approx(0.85));
  CHECK(wider.candidates[rolling].range.high == 2);
  CHECK(place_of(wider, strength) == farthest_of(wider, strength));  // no farther
  // What a parameter set says is in natural units: the same simulations.
  for (const BankPoint& p : plan_group(q, {rolling, {}}, 6)) CHECK(simulation_of(q, p, 0).settings == simulation_of(wider, p, 0).settings);
}

TEST_CASE("a strength beyond its prior is found, for the bank reaches farther by itself") {
  const Diagnosis d = diagnosed(usual(), with(kRolling + "=0.3"));  // the prior ends at 0.2
  INFO(d.sentence);
  REQUIRE(d.named == std::vector<std::string>{"rolling_resistance"});
  const Judged& found = judged(d, "rolling_resistance");
  CHECK_THAT(d.sentence, !Contains("stands at an end"));
  CHECK(found.strength.low < 1.5);
  CHECK(found.strength.high > 1.5);
  CHECK(found.strength.value > 1.2);
  CHECK(found.theta[0].low < 0.3);
  CHECK(found.theta[0].high > 0.3);
  CHECK_THAT(d.sentence, Contains("The range is too narrow: rolling_resistance: rolling_friction = 0.") && Contains("prior range 0 … 0.2"));
  CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
    return note == "rolling_resistance: a fit stands at the upper end of its range, 0.2; simulated up to 0.4, too";
  }));
}

TEST_CASE("intervals of 90 % hold a strength beyond its prior, and the friction beside it, in most of ten recordings") {
  constexpr double kStrength = 1.5, kFriction = 0.3;
  int strengths = 0, frictions = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Diagnosis d = diagnosed(usual(), with(kRolling + "=0.3"), 1, seed);
    const Judged& found = judged(d, "rolling_resistance");
    strengths += found.strength.low < kStrength && found.strength.high > kStrength;
    frictions += found.theta[0].low < kFriction && found.theta[0].high > kFriction;
  }
  // Of ten that each hold in nine of ten cases, less than seven hold in one of 80.
  CHECK(strengths >= 7);
  CHECK(frictions >= 7);
}

TEST_CASE("a strength beyond all that was simulated is said to be unknown") {
  const Diagnosis d = diagnosed(usual(), with(kRolling + "=0.8"));
  INFO(d.sentence);
  CHECK_THAT(d.sentence,
             Contains("The fit stands at an end of what was simulated (rolling_resistance") && Contains("how strong the effect is"));
}

TEST_CASE("friction beyond its range is no physics, and the range is said to be too narrow") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  MadeUpMill mill(q, usual(), {"pairs.glass~glass.static_friction=0.8", kTheta[1], kTheta[2]});
  const Diagnosis d = found(q, mill);
  INFO(d.sentence);
  CHECK(d.verdict == Verdict::no_mismatch);
  CHECK(d.named.empty());
  CHECK_THAT(d.naming.base_theta[0].value, WithinAbs(0.8, 0.05));
  CHECK_THAT(d.sentence, Contains("The range is too narrow: bead_friction = 0.") && Contains("outside its range 0.1 … 0.6"));
  CHECK_THAT(d.next_experiment, Contains("Widen the range"));
  CHECK(d.question.study.parameters[0].high == Approx(0.85));
}

// What acts like more beads would be taken for them, or they for it, where the filling could not leave its range.
TEST_CASE("a filling beyond its range is named as that, and not the physics that acts like it") {
  std::vector<Physics> physics = usual();
  physics[1].direction = {102, 202, 302};  // bridges: what the filling does
  std::vector<std::string> truth = kTheta;
  truth[2] = "fill.filling=0.333";
  const Diagnosis d = diagnosed(physics, truth, 0.3);
  INFO(d.sentence);
  CHECK(d.named == std::vector<std::string>{"filling"});
  CHECK_THAT(d.sentence, !Contains("stands at an end"));
  CHECK_THAT(judged(d, "filling").theta[2].value, WithinAbs(0.333, 0.002));
  CHECK_THAT(d.sentence, Contains("The range is too narrow: filling = 0.33") && Contains("outside its range 0.304 … 0.322"));
}

// The range is short against the prior, so that one recording in seven has its filling beyond it and the bank is often widened by the
// recording itself. At a level of 5 % a name is given in 2 of 40 by chance; 7 and more are broken once in 140.
TEST_CASE("a bank that reaches farther gives no more false names") {
  const Scratch folder;
  const Question q = question_of(folder, "nuisances: {fill.filling: {range: [30.83 %, 31.77 %], sigma: 0.313 %, name: filling}}\n" +
                                             kSections.substr(kSections.find("hypotheses")));
  int named = 0, widened = 0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    base::RandomStream random(271, k);
    std::vector<std::string> truth = kTheta;
    truth[2] = fmt::format("fill.filling={:.4f}", 0.313 + 0.00313 * random.normal());
    MadeUpMill mill(q, usual(), truth, 0.5);
    mill.seed = k;
    const Diagnosis d = found(q, mill);
    named += d.naming.best ? 1 : 0;
    widened += d.question.nuisances[0].low < q.nuisances[0].low || d.question.nuisances[0].high > q.nuisances[0].high ? 1 : 0;
  }
  INFO(named << " names, widened in " << widened);
  CHECK(widened >= 4);
  CHECK(named <= 6);
}

TEST_CASE("a filling beyond all that was simulated is said to be so") {
  std::vector<std::string> truth = kTheta;
  truth[2] = "fill.filling=0.36";
  const Diagnosis d = diagnosed(usual(), truth, 0.3);
  INFO(d.sentence);
  CHECK_THAT(d.sentence, Contains("The fit stands at an end of what was simulated (filling): the value is not known"));
}

TEST_CASE("where nothing of the library helps, what the study takes for granted is asked for first") {
  Physics elsewhere{"pairs.glass~glass.restitution", 0.8, 0.5, 3, {51, 52, 53}};
  std::vector<Physics> physics = usual();
  physics.push_back(elsewhere);
  const Diagnosis d = diagnosed(physics, with("pairs.glass~glass.restitution=0.4"));
  INFO(d.sentence);
  CHECK(d.verdict == Verdict::outside_library);
  CHECK_THAT(d.next_experiment, Contains("First ask whether what this study does not fit is right: pairs.glass~glass.restitution (0.8)"));
}

TEST_CASE("what could be seen for itself but not beside what was found is told") {
  std::vector<Physics> physics = usual();
  physics[1].direction = physics[0].direction, physics[1].size = 0.4;  // a bridge does what rolling friction does, but less
  const Diagnosis d = diagnosed(physics, with(kRolling + "=0.1"), 0.3);
  REQUIRE(d.naming.best);
  REQUIRE(d.problem.alternatives[*d.naming.best].name == "rolling_resistance");
  INFO(d.sentence);
  CHECK(judged(d, "capillary_bridge").lambda > 9);
  CHECK(judged(d, "capillary_bridge").lambda_beside < 9);
  CHECK(judged(d, "lifter_wear").lambda_beside > 9);
  CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
    return note.find("could not show at any strength: capillary_bridge") != std::string::npos &&
           note.find("lifter_wear") == std::string::npos;
  }));
}

TEST_CASE("the bank keeps its simulations where it reaches farther, also those that begin at another's end") {
  const Scratch folder;
  const Question q = question_of(folder, kSections.substr(0, kSections.rfind('}')) + ", develop_turns: 0.5}\n");
  MadeUpMill mill(q, usual(), {"pairs.glass~glass.static_friction=0.8", kTheta[1], kTheta[2]});
  const Diagnosis d = found(q, mill);
  INFO(d.sentence);
  CHECK(d.verdict == Verdict::no_mismatch);
  CHECK_THAT(d.naming.base_theta[0].value, WithinAbs(0.8, 0.05));
  const auto without = planned_runs(q).size(), beyond = plan_beyond(q, {.coordinate = 0, .upper = true}).size() * 3;
  CHECK(static_cast<std::size_t>(mill.computed()) <= without + beyond + 36);  // 36: held out
}

TEST_CASE("a range is not widened where the study's constraints leave nothing beyond") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + "constraints: [bead_friction < 0.61]\n");
  MadeUpMill mill(q, usual(), {"pairs.glass~glass.static_friction=0.8", kTheta[1], kTheta[2]});
  const Diagnosis d = found(q, mill);
  CHECK(d.question.study.parameters[0].high == 0.6);
  CHECK(std::find(d.naming.at_limit.begin(), d.naming.at_limit.end(), "bead_friction") != d.naming.at_limit.end());
}
