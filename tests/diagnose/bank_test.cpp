// The bank: which simulations are planned, that it grows without losing one, what becomes of those that fail.
#include "studies/diagnose/bank/bank.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "made_up_study.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinRel;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

const std::string kNuisance = "nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}}\n";
const std::string kSections = kNuisance + "hypotheses: {lifter_face_angle: {}, rolling_resistance: {}, end_faces_at_rest: {}}\n";

const std::string kRolling = "pairs.glass~glass.rolling_friction";

std::vector<std::string> settings(const Question& q, const BankPoint& p) { return simulation_of(q, p, 0).settings; }

Index candidate(const Question& q, const std::string& name) {
  for (Index j = 0; j < std::ssize(q.candidates); ++j) {
    if (q.candidates[j].name == name) return j;
  }
  throw std::runtime_error("no candidate " + name);
}

/// The setting that all simulations of a condition have.
std::string speed_of(const Question& q, std::size_t condition) { return fmt::format("mill.speed={} rad/s", q.speed[condition]); }

}  // namespace

TEST_CASE("a bank that grows keeps every earlier run") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  for (const Group& group : {Group{}, Group{0}, Group{1}, Group{2}}) {
    const auto few = plan_group(q, group, 8), many = plan_group(q, group, 40);
    REQUIRE(few.size() == 8);
    REQUIRE(many.size() == 40);
    for (std::size_t i = 0; i < few.size(); ++i) CHECK(settings(q, few[i]) == settings(q, many[i]));
  }
  // A group's runs do not change when other groups come.
  const Question alone = question_of(folder, kNuisance + "hypotheses: {rolling_resistance: {}}\n");
  const auto with = plan_group(q, {candidate(q, "rolling_resistance")}, 5), without = plan_group(alone, {0}, 5);
  for (std::size_t i = 0; i < with.size(); ++i) CHECK(settings(q, with[i]) == settings(alone, without[i]));
}

TEST_CASE("all runs of a bank differ, each has a seed of its own") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + "bank: {base: 24, each: 10}\n");
  const std::vector<BankPoint> points = plan_bank(q);
  CHECK(points.size() == 24 + 12 + 3 * 10);
  for (const int base : {8, 16, 20}) {
    const std::vector<BankPoint> again = plan_again(question_of(folder, kSections + fmt::format("bank: {{base: {}, each: 10}}\n", base)));
    CHECK(std::ssize(again) == std::max(8, base / 2));
  }
  std::set<std::vector<std::string>> different;
  std::set<std::string> labels, parameters;
  for (const BankPoint& p : points) {
    different.insert(settings(q, p));
    labels.insert(simulation_of(q, p, 0).label);
    parameters.insert(settings(q, p)[1] + settings(q, p)[2] + settings(q, p)[3]);
  }
  CHECK(different.size() == points.size());
  CHECK(labels.size() == points.size());
  for (const BankPoint& p : points) {
    if (p.group != "again") continue;
    CHECK(p.theta == points[p.index].theta);
    CHECK(settings(q, p) != settings(q, points[p.index]));
  }
  CHECK(parameters.size() > points.size() / 2);  // θ of different groups need not agree
  const auto one = simulation_of(q, points[0], 0).settings, other = simulation_of(q, points[0], 1).settings;
  CHECK(one[0] == speed_of(q, 0));
  CHECK(other[0] == speed_of(q, 1));
  CHECK(one.back() != other.back());
  CHECK(one.back().rfind("seed=", 0) == 0);
}

TEST_CASE("no two runs of a large bank share a seed, and a case takes each") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  std::set<std::string> seeds;
  constexpr int kGroups = 100, kRuns = 40;
  for (int group = 0; group < kGroups; ++group) {
    for (int index = 0; index < kRuns; ++index) {
      const BankPoint point{fmt::format("candidate {}", group), index, VectorXd::Constant(static_cast<Index>(q.dimensions()), 0.31), {}};
      for (std::size_t c = 0; c < q.study.conditions.size(); ++c) seeds.insert(simulation_of(q, point, c).settings.back());
    }
  }
  CHECK(seeds.size() == kGroups * kRuns * q.study.conditions.size());
  for (const std::string& seed : seeds) {
    REQUIRE(seed.rfind("seed=", 0) == 0);
    REQUIRE(std::stoull(seed.substr(5)) < (1ULL << 53));
  }
  const std::string largest = fmt::format("seed={}", (1ULL << 53) - 1);
  CHECK(config::read_case(q.study.base.string(), {largest}).seed == (1ULL << 53) - 1);
}

TEST_CASE("strengths cover what they are meant to, and agree with the rounded values") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  const Index rolling = candidate(q, "rolling_resistance"), angle = candidate(q, "lifter_face_angle");
  double least = 1, most = 0, lowest = 1;
  for (const BankPoint& p : plan_group(q, {rolling}, 64)) {
    REQUIRE(p.active.size() == 1);
    const double strength = p.active[0].strength;
    CHECK(strength >= 0.1 - 1e-3);
    CHECK(strength <= 1);
    least = std::min(least, strength), most = std::max(most, strength);
    const Candidate& c = q.candidates[rolling];
    CHECK_THAT(c.value(strength), WithinRel(rounded(c.value(strength)), 1e-12));
  }
  CHECK(least < 0.2);
  CHECK(most > 0.9);
  for (const BankPoint& p : plan_group(q, {angle}, 64)) lowest = std::min(lowest, p.active[0].strength);
  CHECK(lowest < -0.8);
  CHECK(lowest >= q.candidates[angle].range.low - 1e-3);
  for (const BankPoint& p : plan_group(q, {candidate(q, "end_faces_at_rest")}, 8)) CHECK(p.active[0].strength == 1);
  for (const BankPoint& p : plan_group(q, {}, 8)) CHECK(p.active.empty());
}

TEST_CASE("parameters stay within their ranges, have four digits and break no constraint") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + "constraints: [wall_friction < bead_friction]\n");
  const auto points = plan_group(q, {}, 40);
  CHECK(points.size() < 40);
  CHECK(points.size() > 10);
  const std::vector<Coordinate> theta = q.coordinates();
  for (const BankPoint& p : points) {
    CHECK(p.theta[1] < p.theta[0]);
    for (Index i = 0; i < p.theta.size(); ++i) {
      CHECK(p.theta[i] == rounded(p.theta[i]));
      CHECK(p.theta[i] >= theta[i].low);
      CHECK(p.theta[i] <= theta[i].high);
    }
  }
}

TEST_CASE("a parameter set of which one condition failed is left out, and said") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  MadeUpMill mill(q, {}, {});
  mill.fails = [&](const auto& s) {
    return "mill.speed=" + s.at("mill.speed") == speed_of(q, 1) && std::stod(s.at("fill.filling")) > 0.315;
  };
  const std::vector<BankPoint> points = plan_group(q, {}, 16);
  const Bank bank = fill_bank(q, mill.machinery(), mill.evidence(), points, {0, 1});
  CHECK(mill.computed() == 32);
  std::size_t failed = 0;
  for (const BankPoint& p : points) failed += p.theta[2] > 0.315 ? 1 : 0;
  REQUIRE(failed > 0);
  REQUIRE(failed < 16);
  CHECK(bank.failures.size() == failed);
  CHECK_THAT(bank.failures.front(), Contains("base_") && Contains("speed60: a bead ran away"));
  const BankData both = data_of(q, bank, {0, 1}), first = data_of(q, bank, {0});
  CHECK(both.rows.size() == 16 - failed);
  CHECK(first.rows.size() == 16);
  CHECK(both.value.cols() == 32);
  CHECK(both.condition.front() == 0);
  CHECK(both.condition.back() == 1);
  CHECK(both.condition.size() == 32);
  for (const BankRow& row : both.rows) CHECK(row.theta[2] <= 0.315);
  mill.fails = [](const auto&) { return true; };
  const Bank none = fill_bank(q, mill.machinery(), mill.evidence(), points, {0});
  CHECK_THAT(testing::refusal([&] { data_of(q, none, {0}); }),
             Contains("no simulation of the bank has come to its end; the first: base_0_speed75: a bead ran away; correct the base case"));
}

TEST_CASE("numbers stand under their condition when the first parameter set has failed") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  MadeUpMill mill(q, {}, {});
  const std::vector<BankPoint> points = plan_group(q, {}, 8);
  const std::string first = settings(q, points[0])[1];
  mill.fails = [&](const auto& s) {
    return "pairs.glass~glass.static_friction=" + s.at("pairs.glass~glass.static_friction") == first &&
           "mill.speed=" + s.at("mill.speed") == speed_of(q, 1);
  };
  const BankData data = data_of(q, fill_bank(q, mill.machinery(), mill.evidence(), points, {0, 1}), {0, 1});
  REQUIRE(data.condition.size() == 32);
  CHECK(data.condition[15] == 0);
  CHECK(data.condition[16] == 1);
}

TEST_CASE("a bank knows where each of its simulations is") {
  const Scratch folder;
  const Question q = question_of(folder, kSections);
  MadeUpMill mill(q, {}, {});
  const std::vector<BankPoint> points = plan_group(q, {}, 8);
  calibrate::Machinery machinery = mill.machinery();
  machinery.run = [run = machinery.run](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes = run(simulations);
    for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i].folder = simulations[i].label;
    return outcomes;
  };
  const Bank bank = fill_bank(q, machinery, mill.evidence(), points, {1, 0});
  for (std::size_t p = 0; p < points.size(); ++p)
    CHECK(bank.runs[p] == std::vector<std::filesystem::path>{simulation_of(q, points[p], 1).label, simulation_of(q, points[p], 0).label});
}

TEST_CASE("what the camera is doubted of costs no simulation") {
  const Scratch folder;
  const std::string camera =
      "camera.frame_error.offset_x: {range: [-5 mm, 5 mm], sigma: 1 mm, name: axis_x}, "
      "camera.frame_error.scale: {range: [-2 %, 2 %], sigma: 0.5 %}";
  const std::string hypotheses = "hypotheses: {lifter_face_angle: {}, rolling_resistance: {}, end_faces_at_rest: {}}\n";
  const Question plain = question_of(folder, kSections);
  // Named before the filling: those of the camera come last all the same.
  const Question doubted =
      question_of(folder, "nuisances: {" + camera + ", fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}}\n" + hypotheses);
  REQUIRE(doubted.dimensions() == 5);
  CHECK(doubted.case_dimensions() == 3);
  CHECK(plain.camera(plan_group(plain, {}, 1)[0].theta).empty());
  std::set<std::string> cameras;
  for (const Group& group : {Group{}, Group{0}, Group{1}, Group{2}}) {
    const auto with = plan_group(doubted, group, 20), without = plan_group(plain, group, 20);
    for (std::size_t i = 0; i < with.size(); ++i) {
      CHECK(settings(doubted, with[i]) == settings(plain, without[i]));
      CHECK(with[i].theta[3] >= -0.005);
      CHECK(with[i].theta[3] <= 0.005);
      cameras.insert(doubted.camera(with[i].theta));
    }
  }
  CHECK(cameras.size() > 70);
  VectorXd theta(5);
  theta << 0.3, 0.4, 0.313, 0.004, -0.01;
  CHECK(doubted.camera(theta) == "schema_version: 1\nobservations:\n  doubted_frame: {kind: frame_error, offset_x: 0.004, scale: -0.01}\n");
  MadeUpMill mill(doubted, {}, {});
  const BankData data = data_of(doubted, fill_bank(doubted, mill.machinery(), mill.evidence(), plan_group(doubted, {}, 8), {0}), {0});
  CHECK(data.theta[3].products == Products::none);
  CHECK(data.theta[2].products == Products::all);
}

// The stiffness is varied apart. Named first, it stands behind the filling and before the camera.
const std::string kStiffnessApart =
    "nuisances: {camera.frame_error.scale: {range: [-2 %, 2 %], sigma: 0.5 %}, "
    "stiffness_factor: {range: [0.001, 0.01], mean: 0.004, sigma: 0.003, name: stiffness, apart: true}, "
    "fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}}\n"
    "hypotheses: {lifter_face_angle: {}, rolling_resistance: {}, end_faces_at_rest: {}}\n";

TEST_CASE("a nuisance that is varied apart has a group of its own, and costs the other groups nothing") {
  const Scratch folder;
  const Question plain = question_of(folder, kSections), q = question_of(folder, kStiffnessApart);
  REQUIRE(q.dimensions() == 5);
  CHECK(q.case_dimensions() == 3);
  for (const Group& group : {Group{}, Group{0}, Group{1}, Group{2}}) {
    const auto with = plan_group(q, group, 20), without = plan_group(plain, group, 20);
    for (std::size_t i = 0; i < with.size(); ++i) {
      CHECK(settings(q, with[i]) == settings(plain, without[i]));
      CHECK(with[i].theta[3] == 0.001);
    }
  }
  REQUIRE(varied_apart(plain).empty());
  REQUIRE(varied_apart(q).size() == 1);
  const std::vector<BankPoint> points = plan_group(q, {{}, varied_apart(q)[0]}, 32);
  int stiff = 0;
  double most = 0;
  for (const BankPoint& p : points) {
    CHECK(p.group == "stiffness");
    CHECK(p.active.empty());
    const std::vector<std::string> s = settings(q, p);
    CHECK_THAT(s[4], Catch::StartsWith("stiffness_factor=0.00"));
    stiff += p.theta[3] > 0.00316 ? 1 : 0;  // half of them, as it is spread by its logarithm
    most = std::max(most, p.theta[3]);
  }
  CHECK(stiff >= 14);
  CHECK(stiff <= 18);
  CHECK(most > 0.008);
  CHECK(most <= 0.01);
  // Every candidate with it, half as many as alone; screening does without them.
  CHECK(plan_bank(q).size() == plan_bank(plain).size() + static_cast<std::size_t>(q.bank.apart + 3 * q.bank.each / 2));
  CHECK(plan_screening(q).size() == plan_screening(plain).size() + static_cast<std::size_t>(q.bank.apart));
}

TEST_CASE("a nuisance that is varied apart is varied with each candidate, too, half as often as that alone") {
  const Scratch folder;
  const Question q = question_of(folder, kStiffnessApart);
  const Index rolling = candidate(q, "rolling_resistance");
  const std::vector<BankPoint> alone = plan_group(q, {rolling}, q.bank.each), together = plan_together(q, rolling, 3);
  REQUIRE(together.size() == 5);
  for (const BankPoint& p : together) {
    CHECK(p.group == "rolling_resistance*stiffness");
    REQUIRE(p.active.size() == 1);
    const auto pair = static_cast<std::size_t>(2 * p.index);
    CHECK(p.active[0].strength == std::max(alone[pair].active[0].strength, alone[pair + 1].active[0].strength));
    CHECK(p.theta[3] >= 0.003);  // the case's 0.001 is the soft end: the stiffer half
  }
  CHECK(together[0].theta[3] == 0.01);
  CHECK(together[1].theta[3] != together[0].theta[3]);
  // A bank that grows keeps them; one that is too small for a product has none.
  Question odd = q;
  odd.bank.each = 9;
  CHECK(plan_together(odd, rolling, 3).size() == 5);
  CHECK(settings(q, plan_together(odd, rolling, 3)[4]) == settings(q, together[4]));
  // A candidate that is on or off, about a case in the middle of the range: both ends, and both halves of each friction.
  Question middle = q;
  middle.nuisances[1].usual = 0.003, middle.bank.each = 16;
  std::set<double> places;
  std::set<bool> halves;
  for (const BankPoint& p : plan_together(middle, candidate(q, "end_faces_at_rest"), 3))
    places.insert(p.theta[3]), halves.insert(p.theta[1] > 0.375);
  CHECK(places == std::set<double>{0.001, 0.01});
  CHECK(halves.size() == 2);
  Question larger = q, small = q;
  larger.bank.each = 40, small.bank.each = 4;
  const std::vector<BankPoint> more = plan_together(larger, rolling, 3);
  CHECK(more.size() == 20);
  for (std::size_t i = 0; i < together.size(); ++i) CHECK(settings(q, together[i]) == settings(q, more[i]));
  CHECK(plan_together(small, rolling, 3).empty());
}

TEST_CASE("a candidate of which too few runs with a nuisance apart came to their end is known without the product of the two") {
  const Scratch folder;
  const Question q = question_of(folder, kStiffnessApart);
  const Index rolling = candidate(q, "rolling_resistance");
  MadeUpMill fragile(q, {}, {});
  fragile.fails = [](const auto& s) {
    return s.contains("stiffness_factor") && s.contains(kRolling) && s.at("stiffness_factor") != "0.01";
  };
  const BankData few = data_of(q, fill_bank(q, fragile.machinery(), fragile.evidence(), plan_bank(q), {0}), {0});
  const auto is_rolling = [&](const BankRow& row) { return row.candidate() == rolling; };
  CHECK(std::count_if(few.rows.begin(), few.rows.end(), is_rolling) == q.bank.each);
  REQUIRE(few.left_out.size() == 2);
  CHECK_THAT(few.left_out[0], Contains("simulations of the bank failed"));
  CHECK_THAT(few.left_out[1], Contains("rolling_resistance with another stiffness was left out: 2 and 10 simulations"));
  // Linear, square and × the two frictions.
  MadeUpMill mill(q, {}, {});
  BankData data = data_of(q, fill_bank(q, mill.machinery(), mill.evidence(), plan_bank(q), {0}), {0});
  CHECK(data.left_out.empty());
  const Index with = Features(data).base_size();
  CHECK(Features(data).count(rolling) == 5);  // linear, square, × two frictions and × stiffness
  CHECK(Features(few).count(rolling) == 4);
  data.theta[3].products = Products::none;
  CHECK(with == Features(data).base_size() + 2);
  CHECK(data.theta[3].logarithmic);
  CHECK_THAT(data.theta[3].prior_weight(), WithinRel(0.5 * std::log(10.0) * 0.004 / 0.003, 1e-12));
}

TEST_CASE("a nuisance apart whose simulations fail is refused with the remedy") {
  const Scratch folder;
  const Question q = question_of(folder,
                                 "nuisances: {stiffness_factor: {range: [0.001, 0.01], sigma: 0.003, name: stiffness, apart: true}}\n"
                                 "hypotheses: {rolling_resistance: {}}\n");
  MadeUpMill mill(q, {}, {});
  // Runs with a candidate do not tell what the nuisance does without it.
  mill.fails = [](const auto& s) {
    return s.contains("stiffness_factor") && !s.contains(kRolling) && std::stod(s.at("stiffness_factor")) > 0.0012;
  };
  const Bank bank = fill_bank(q, mill.machinery(), mill.evidence(), plan_bank(q), {0});
  CHECK_THAT(testing::refusal([&] { data_of(q, bank, {0}); }),
             Contains("finished simulations of the bank without a candidate vary the nuisance 'stiffness', 6 are needed; raise bank.apart, "
                      "or leave the nuisance out"));
}
