// Two candidates at once: what the bank has of them, and what is said.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "made_up_diagnosis.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::WithinAbs;
using Catch::Matchers::Contains;
using testing::Scratch;

TEST_CASE("two candidates are simulated together, alike in either order") {
  const Scratch folder;
  const Question q = question_of(folder, std::string("nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}}\n") +
                                             "hypotheses: {rolling_resistance: {}, capillary_bridge: {}}\n");
  const Index rolling = 0, bridge = 1;  // as listed
  const std::vector<BankPoint> one = plan_pair(q, rolling, bridge), other = plan_pair(q, bridge, rolling);
  REQUIRE(std::ssize(one) == q.bank.each);
  double sum = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].group == "capillary_bridge+rolling_resistance");
    CHECK(other[i].theta == one[i].theta);
    REQUIRE(one[i].active.size() == 2);
    CHECK(simulation_of(q, one[i], 0).settings == simulation_of(q, other[i], 0).settings);
    sum += (one[i].active[0].strength - 0.55) * (one[i].active[1].strength - 0.55);
  }
  CHECK(std::fabs(sum) < 0.04 * static_cast<double>(one.size()));  // neither goes along with the other
}

TEST_CASE("two candidates of which too few runs together came to their end are known by those alone, and that is said") {
  const Scratch folder;
  const Question q = question_of(folder, std::string("nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}}\n") +
                                             "hypotheses: {rolling_resistance: {}, capillary_bridge: {}}\n");
  MadeUpMill mill(q, {}, {});
  std::vector<BankPoint> points = plan_group(q, {}, 24), both = plan_pair(q, 0, 1);
  both.resize(2);
  points.insert(points.end(), both.begin(), both.end());
  const naming::BankData data = data_of(q, fill_bank(q, mill.machinery(), mill.evidence(), points, {0, 1}), {0, 1});
  CHECK(data.rows.size() == 24);
  CHECK(data.value.rows() == 24);
  REQUIRE(data.left_out.size() == 1);
  CHECK_THAT(data.left_out[0], Contains("rolling_resistance was left out: 2 simulations of both came to their end, 3 are needed"));
}

TEST_CASE("two effects that are not all that is missing are both told, though neither is named") {
  std::vector<Physics> physics = usual();
  physics.push_back({"pairs.glass~glass.restitution", 0.8, 0.5, 2.5, {51, 52, 53}});  // what the two do together besides
  const Diagnosis d = diagnosed(physics, with(kRolling + "=0.16", kBridge + "=0.06", "pairs.glass~glass.restitution=0.4"));
  INFO(d.sentence);
  CHECK(d.verdict == Verdict::outside_library);
  CHECK(d.named.empty());
  CHECK_THAT(d.sentence,
             Contains("beside it helps significantly, too") && Contains("the two do not suffice either, with simulations of both"));
}

TEST_CASE("two effects that do not add up are both named where the bank has them together") {
  std::vector<Physics> physics = usual();
  Physics both{kRolling, 0, 0.2, 3, {51, 52, 53}};
  both.beside = kBridge, both.beside_far = 0.08;
  physics.push_back(both);
  const Diagnosis d = diagnosed(physics, with(kRolling + "=0.16", kBridge + "=0.06"));
  INFO(d.sentence);
  CHECK(std::set<std::string>(d.named.begin(), d.named.end()) == std::set<std::string>{"rolling_resistance", "capillary_bridge"});
  REQUIRE(d.naming.pairs.size() == 1);
  CHECK(d.naming.pairs[0].goodness_p > 0.05);
  for (const double strength : d.naming.pairs[0].fit.strengths) CHECK_THAT(strength, WithinAbs(0.775, 0.15));  // 0.8 and 0.75
  CHECK(std::any_of(d.bank.points.begin(), d.bank.points.end(), [](const BankPoint& p) { return p.active.size() == 2; }));
}

TEST_CASE("a second effect that shows nothing of what it does alone is found") {
  std::vector<Physics> physics = usual();
  Physics both{kHeight, 0.005, 0.003, -2 * physics[2].size, physics[2].direction};  // beside rolling friction the opposite
  both.beside = kRolling, both.beside_far = 0.16;
  physics.push_back(both);
  const Diagnosis d = diagnosed(physics, with(kRolling + "=0.16", kHeight + "=0.0035"));
  INFO(d.sentence);
  CHECK(std::set<std::string>(d.named.begin(), d.named.end()) == std::set<std::string>{"rolling_resistance", "lifter_wear"});
}

TEST_CASE("what helps is simulated twice as often before anything is judged") {
  const Diagnosis d = diagnosed(usual(), with(kRolling + "=0.12"));
  const auto of = [&](const std::string& group) {
    return std::count_if(d.bank.points.begin(), d.bank.points.end(), [&](const BankPoint& p) { return p.group == group; });
  };
  CHECK(of("rolling_resistance") == 20);
  CHECK(of("capillary_bridge") == 10);
  CHECK(judged(d, "rolling_resistance").runs == 20 + of("capillary_bridge+rolling_resistance") + of("lifter_wear+rolling_resistance"));
  CHECK(std::count(d.notes.begin(), d.notes.end(), "simulated twice as often, for it helps: rolling_resistance") == 1);
}

TEST_CASE("nothing is simulated further where nothing helps surely") {
  const Diagnosis d = diagnosed(usual(), kTheta);
  CHECK(std::none_of(d.notes.begin(), d.notes.end(), [](const std::string& n) { return n.starts_with("simulated "); }));
  CHECK(std::none_of(d.bank.points.begin(), d.bank.points.end(), [](const BankPoint& p) { return p.active.size() == 2; }));
}
