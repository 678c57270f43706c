// What of a held-out condition is predicted from the bank, what is simulated, and that a name rests on simulations.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <set>

#include "kernel/base/random.hpp"
#include "made_up_study.hpp"
#include "studies/diagnose/bank/bank_status.hpp"
#include "studies/diagnose/verdict/diagnosis.hpp"
#include "studies/diagnose/verdict/judge.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

const std::string kRolling = "pairs.glass~glass.rolling_friction", kBridge = "pairs.glass~glass.surface_tension";
constexpr int kSeeds = 6;

/// Two effects, alike where `alike` and each with a signature of its own otherwise.
struct Story {
  explicit Story(const std::vector<std::string>& more = {}, bool alike = false)
      : question(question_of(folder,
                             "nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %, name: filling}}\n"
                             "hypotheses: {rolling_resistance: {}, capillary_bridge: {}}\n"
                             "bank: {base: 24, each: 10}\n")),
        truth{"pairs.glass~glass.static_friction=0.3", "pairs.glass~liner.static_friction=0.4", "fill.filling=0.313"} {
    truth.insert(truth.end(), more.begin(), more.end());
    const std::vector<std::uint64_t> bridge = alike ? std::vector<std::uint64_t>{21, 22, 23} : std::vector<std::uint64_t>{31, 32, 33};
    physics = {{kRolling, 0, 0.2, 3, {21, 22, 23}}, {kBridge, 0, 0.08, 3, bridge}};
  }

  Diagnosis diagnosed(double run_noise = 0.3, double aside = 0) {
    MadeUpMill mill(question, physics, truth);
    mill.run_noise = run_noise;
    mill.seed = seed, mill.idle = idle;
    Evidence evidence = mill.evidence();
    evidence.recorded[2].value.array() += aside;
    naming::Options options;
    options.draws = 240, options.comparison_draws = 160;
    Diagnosis d = diagnose::diagnose(question, mill.machinery(), evidence, options);
    computed = mill.computed();
    simulated = d.held_out.at(0).simulations;
    return d;
  }

  Scratch folder;
  Question question;
  std::vector<std::string> truth;
  std::vector<Physics> physics;
  std::uint64_t seed = 0;                ///< of all noise
  std::optional<std::size_t> idle = {};  ///< a condition in which wall friction does nothing
  int computed = 0;                      ///< simulations of all kinds
  int simulated = 0;                     ///< of models in the held-out condition
};

const Score* score_of(const HeldOut& held, const std::string& name) {
  const auto found = std::find_if(held.scores.begin(), held.scores.end(), [&](const Score& s) { return s.prediction.name == name; });
  return found == held.scores.end() ? nullptr : &*found;
}

bool simulated(const HeldOut& held, const std::string& name) {
  const Score* score = score_of(held, name);
  REQUIRE(score != nullptr);
  return score->prediction.simulated;
}

/// A naming of which nothing but the held-out conditions is open.
naming::Result nearly_named() {
  naming::Result r;
  r.judged.resize(2);
  r.judged[0].goodness_p = 0.5;
  r.best = 0;
  r.kept = {0};
  return r;
}

}  // namespace

// Two that these data cannot tell apart: nothing is about to be named, so that the bank's predictions would do.
TEST_CASE("a fit at an end of what was simulated is simulated in the held-out condition, named or not") {
  Story within({kRolling + "=0.1"}, true), beyond({kRolling + "=0.9"}, true);
  const Diagnosis usual = within.diagnosed(), far = beyond.diagnosed();
  REQUIRE(usual.naming.kept.size() == 2);
  REQUIRE(far.naming.best);
  REQUIRE_THAT(far.sentence, Contains("stands at an end of what was simulated"));
  CHECK_FALSE(simulated(usual.held_out[0], "corrected"));
  CHECK(simulated(far.held_out[0], "corrected"));
}

TEST_CASE("what a candidate does in a held-out condition is simulated where it is in the class, or the base needs it") {
  using Groups = std::set<std::string>;
  // Groups of which the held-out condition has simulations, none by half; "…+…": of two together.
  const auto held_groups = [](int base, const std::vector<std::string>& truth, bool alike = false) {
    Story story(truth, alike);
    story.question.bank.base = base;
    const Diagnosis d = story.diagnosed();
    CHECK(d.naming.best.has_value() == !truth.empty());
    const std::size_t k = d.bank.place_of(2).value();
    Groups whole, some;
    for (const BankPoint& p : d.bank.points) whole.insert(p.group);
    for (std::size_t p = 0; p < d.bank.points.size(); ++p) {
      if (d.bank.seen[p][k])
        some.insert(d.bank.points[p].group);
      else
        whole.erase(d.bank.points[p].group);
    }
    CHECK(whole == some);
    return some;
  };
  CHECK(held_groups(19, {}) == Groups{"again", "base", "capillary_bridge", "rolling_resistance"});
  CHECK(held_groups(20, {}) == Groups{"again", "base"});  // ten coefficients
  CHECK(held_groups(40, {kRolling + "=0.12"}) == Groups{"again", "base", "rolling_resistance"});
  CHECK(held_groups(40, {kRolling + "=0.12"}, true) ==
        Groups{"again", "base", "capillary_bridge", "capillary_bridge+rolling_resistance", "rolling_resistance"});
  const Groups beyond = held_groups(40, {kRolling + "=0.26"});
  CHECK(beyond.count("rolling_resistance>") == 1);
  CHECK(std::none_of(beyond.begin(), beyond.end(), [](const std::string& group) { return group.starts_with("capillary_bridge"); }));
}

TEST_CASE("where nothing is missing the bank predicts the held-out condition, and nothing is simulated for it") {
  Story story;
  const Diagnosis d = story.diagnosed();
  CHECK(d.verdict == Verdict::no_mismatch);
  REQUIRE(d.held_out.size() == 1);
  const HeldOut& held = d.held_out[0];
  CHECK(held.simulations == 0);
  const auto bare = std::count_if(d.bank.points.begin(), d.bank.points.end(), [](const BankPoint& p) { return p.active.empty(); });
  CHECK(story.computed == 2 * std::ssize(d.bank.points) + bare);
  REQUIRE(held.scores.size() == 2);
  for (const Score& s : held.scores) {
    CHECK_FALSE(s.prediction.simulated);
    CHECK(s.reliance.enough());
    CHECK(s.misfit < 2);
    CHECK(std::fabs(s.prediction.power - d.evidence.recorded[2].power.value) < 5);
  }
  CHECK(held.base_p > 0.05);
  CHECK(sources_sentence(held) == "retuned to power, retuned to all observables predicted by the bank's surrogate");
}

namespace {

struct Alarms {
  double tried = 0, at_5_percent = 0, mean_p = 0;
  double rate() const { return at_5_percent / tried; }
};

/// Of the base itself, one speed fitted and two held out. Its filling lies as the prior says.
Alarms alarms_of_base(int stories, const std::optional<std::size_t>& idle) {
  Alarms found;
  for (int k = 0; k < stories; ++k) {
    Story story;
    story.seed = static_cast<std::uint64_t>(k), story.idle = idle;
    story.truth.back() = fmt::format("fill.filling={}", 0.313 + 0.00313 * base::RandomStream(17, story.seed).normal());
    story.question.study.conditions[1].role = calibrate::Role::held_out;
    for (const HeldOut& held : story.diagnosed().held_out)
      ++found.tried, found.mean_p += held.base_p, found.at_5_percent += held.base_p < 0.05 ? 1 : 0;
  }
  found.mean_p /= found.tried;
  return found;
}

}  // namespace

TEST_CASE("a recording of the base itself looks other than the refitted base in a held-out condition as seldom as the level says") {
  constexpr int kStories = 100;
  const Alarms found = alarms_of_base(kStories, {});
  INFO("mean p " << found.mean_p << ", " << found.at_5_percent << " of " << found.tried << " below 0.05");
  CHECK(found.tried == 2 * kStories);
  // The two of a story share a fit: the errors below take them for one.
  CHECK(found.rate() < 0.05 + 3 * std::sqrt(0.05 * 0.95 / kStories));
  CHECK(std::fabs(found.mean_p - 0.5) < 3 / std::sqrt(12.0 * kStories));
}

TEST_CASE("what a parameter does in a held-out condition raises few alarms where the fitted recordings tell nothing of it") {
  const Alarms found = alarms_of_base(40, 0);
  INFO("mean p " << found.mean_p << ", " << found.at_5_percent << " of " << found.tried << " below 0.05");
  CHECK(found.rate() < 0.25);  // 12 of 80, for what it does is taken for linear; 51 without what the fit leaves open
}

TEST_CASE(
    "two parameter sets for each coefficient of the base raise no other alarm than five, of runs that scatter more than the recording") {
  constexpr int kStories = 12;
  constexpr double kRunNoise = 1.5;
  const auto p_of = [](int base, std::uint64_t seed, double aside) {
    Story story;
    story.seed = seed;
    story.question.bank.base = base;
    return story.diagnosed(kRunNoise, aside).held_out.at(0).base_p;
  };
  double sum = 0;
  int alarms = 0, alarms_of_more = 0;
  for (std::uint64_t seed = 0; seed < kStories; ++seed) {
    sum += p_of(20, seed, 0) - p_of(48, seed, 0);  // ten coefficients
    alarms += p_of(20, seed, 1.5) < 0.05;
    alarms_of_more += p_of(48, seed, 1.5) < 0.05;
  }
  UNSCOPED_INFO("p " << sum / kStories << ", alarms " << alarms << " and " << alarms_of_more);
  CHECK(std::fabs(sum / kStories) < 0.1);
  CHECK(alarms >= alarms_of_more - 2);
}

TEST_CASE("a diagnosis that finds nothing asks for no simulation of the bank that is not planned, and for all that are") {
  for (const int base : {19, 20}) {  // candidates in the held-out condition or none
    Story story;
    story.question.bank.base = base;
    MadeUpMill mill(story.question, story.physics, story.truth);
    std::vector<campaign::Simulation> planned;
    for (const PlannedRun& run : planned_runs(story.question)) planned.push_back(run.simulation);
    mill.machinery().run(planned);
    const int before = mill.computed();
    CHECK(before == std::ssize(planned));
    CHECK(story.diagnosed().verdict == Verdict::no_mismatch);
    CHECK(story.computed == before + story.simulated);
  }
}

TEST_CASE("where the bank's runs scatter too much to judge by, all is simulated") {
  Story story;
  const Diagnosis d = story.diagnosed(6);
  REQUIRE(d.held_out.size() == 1);
  CHECK(d.held_out[0].simulations == 2 * kSeeds);
  for (const Score& s : d.held_out[0].scores) CHECK(s.prediction.simulated);
}

TEST_CASE("a name rests on simulations: the corrected case, the base retuned to power, and all that may be the strongest rival") {
  Story story({kRolling + "=0.12"});
  const Diagnosis d = story.diagnosed();
  INFO(d.sentence);
  CHECK(d.verdict == Verdict::named);
  const HeldOut& held = d.held_out.at(0);
  CHECK(held.rests_on_simulations());
  CHECK(simulated(held, "corrected"));
  CHECK(simulated(held, "retuned to power"));
  std::vector<base::Interval90> improvements;
  for (std::size_t k = 1; k < held.scores.size(); ++k) improvements.push_back(held.scores[k].improvement);
  for (const std::size_t k : near_strongest(improvements)) CHECK(held.scores[k + 1].prediction.simulated);
  // Those that are computed from the refitted base rest on what it rests on.
  for (const char* name : {"placebo", "Gaussian-process discrepancy"})
    CHECK(simulated(held, name) == simulated(held, "retuned to all observables"));
  CHECK(held.simulations <= 4 * kSeeds);
  CHECK(held.simulations % kSeeds == 0);
  std::size_t in_bank = 0;
  for (const auto& point : d.bank.seen)
    in_bank += std::count_if(point.begin(), point.end(), [](const auto& seen) { return seen.has_value(); });
  CHECK(static_cast<std::size_t>(story.computed) >= in_bank + held.simulations);
  CHECK_THAT(sources_sentence(held), Contains("corrected, ") && Contains(fmt::format("({} simulations)", held.simulations)));

  // The same figures without the simulations of any one of them name nothing.
  const auto verdict_without = [&](const std::string& name) {
    Diagnosis predicted = d;
    predicted.named.clear(), predicted.notes.clear();
    for (Score& s : predicted.held_out[0].scores) {
      if (s.prediction.name == name) s.prediction.simulated = false;
    }
    conclude(story.question, 0.05, 3, predicted);
    return predicted.verdict;
  };
  CHECK(verdict_without("nobody") == Verdict::named);
  CHECK(verdict_without("corrected") == Verdict::ambiguous);
  CHECK(verdict_without("retuned to power") == Verdict::ambiguous);
  CHECK(verdict_without(held.scores[strongest(improvements) + 1].prediction.name) == Verdict::ambiguous);
}

TEST_CASE("a class of two is not about to be named: what is told of the held-out condition is predicted") {
  Story story({kRolling + "=0.12"}, true);
  const Diagnosis d = story.diagnosed();
  INFO(d.sentence);
  REQUIRE(d.verdict == Verdict::ambiguous);
  REQUIRE(d.named.size() == 2);
  CHECK_FALSE(simulated(d.held_out.at(0), "corrected"));
  for (const Score& s : d.held_out[0].scores) {  // alone a fit at an end of what was simulated is simulated
    INFO(s.prediction.name);
    if (s.prediction.simulated) CHECK_FALSE(naming::ends_of(d.problem, d.problem.data.coded(s.prediction.theta), {}).empty());
  }
  for (std::size_t k = 1; k < d.held_out[0].scores.size(); ++k) CHECK(d.held_out[0].scores[k].reliance.enough());
}

TEST_CASE("that something differs in the held-out condition alone is said after the base was simulated there") {
  Story story;
  const Diagnosis d = story.diagnosed(0.3, 8);
  INFO(d.sentence);
  CHECK_THAT(d.sentence, Contains("does not describe the held-out condition 'speed50'"));
  CHECK(simulated(d.held_out.at(0), "retuned to all observables"));
  CHECK(d.held_out[0].simulations == kSeeds);
}

TEST_CASE("an alarm is not lost in the surrogate's error: the base is simulated where it would differ if the prediction were exact") {
  Story story;
  const Diagnosis d = story.diagnosed(1.5, 2.5);
  const HeldOut& held = d.held_out.at(0);
  CHECK(simulated(held, "retuned to all observables"));
  CHECK(held.strict_base_p == held.base_p);
}

TEST_CASE("a candidate is about to be named when it is significant, sufficient, alone, and none is asked for beside it") {
  CHECK(about_to_name(nearly_named(), 0.05));
  naming::Result r = nearly_named();
  r.best.reset();
  CHECK_FALSE(about_to_name(r, 0.05));
  r = nearly_named(), r.kept = {0, 1};
  CHECK_FALSE(about_to_name(r, 0.05));
  r = nearly_named(), r.judged[0].goodness_p = 0.05;
  CHECK_FALSE(about_to_name(r, 0.05));
  r = nearly_named(), r.pairs = {{0, 1, {}, 0.01, 0.01, 0.5}};
  CHECK_FALSE(about_to_name(r, 0.05));
  r.pairs[0].p_first = 0.2;  // the second would do alone
  CHECK(about_to_name(r, 0.05));
}
