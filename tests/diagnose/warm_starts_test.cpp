// Which simulation of a bank begins at which other one's end.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "made_up_study.hpp"
#include "studies/diagnose/bank/bank_status.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::Contains;
using testing::Scratch;

namespace {

const std::string kSections =
    "nuisances:\n"
    "  fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %}\n"
    "  stiffness_factor: {range: [0.0005, 0.02], mean: 0.005, sigma: 0.003, apart: true}\n"
    "hypotheses: {lifter_face_angle: {}, rolling_resistance: {}, end_faces_at_rest: {}}\n";

std::string bank(int base, int each, const std::string& more = ", develop_turns: 0.5") {
  return fmt::format("bank: {{base: {}, each: {}{}}}\n", base, each, more);
}

/// A simulation's label and those from which it stems, its own donor first; the settings stand for each.
std::vector<std::vector<std::string>> line_of(const campaign::Simulation& s) {
  std::vector<std::vector<std::string>> line{s.settings};
  for (auto donor = s.donor; donor; donor = donor->donor) line.push_back(donor->settings);
  return line;
}

struct Planned {
  std::vector<BankPoint> points;
  std::vector<campaign::Simulation> simulations;  ///< of condition 0
};

Planned planned(const Question& q) {
  Planned p{plan_bank(q), {}};
  p.simulations = simulations_of(q, p.points, {0});
  return p;
}

std::string value_of(const std::vector<std::string>& settings, const std::string& path) {
  for (const std::string& s : settings) {
    if (s.starts_with(path + "=")) return s.substr(path.size() + 1);
  }
  return "";
}

}  // namespace

TEST_CASE("without a time to develop every simulation of a bank begins at rest") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + bank(24, 10, ""));
  const Planned p = planned(q);
  for (std::size_t i = 0; i < p.points.size(); ++i) {
    CHECK_FALSE(p.simulations[i].donor);
    CHECK(p.simulations[i].settings == simulation_of(q, p.points[i], 0).settings);
  }
}

TEST_CASE("each end is given once, within group and condition, and two of a group begin at rest") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + bank(24, 10));
  const std::vector<PlannedRun> runs = planned_runs(q);
  std::set<std::vector<std::string>> given;
  std::map<std::pair<std::string, std::size_t>, int> at_rest;
  int warm = 0;
  for (const PlannedRun& run : runs) {
    if (!run.simulation.donor) {
      ++at_rest[{run.group, run.condition}];
      continue;
    }
    ++warm;
    CHECK(run.simulation.develop_s == Approx(0.5 * 2 * std::numbers::pi / q.speed[run.condition]).margin(1e-4));
    CHECK(given.insert(run.simulation.donor->settings).second);
    CHECK(run.simulation.donor->label.starts_with(run.group + "_"));
    CHECK(run.simulation.donor->label.ends_with("_" + q.study.conditions[run.condition].name));
  }
  CHECK(warm == 3 * (22 + 10) + 2 * (2 * 8));  // with a candidate in the fitted conditions alone
  CHECK(at_rest[{"base", 0}] == 2);
  CHECK(at_rest[{"again", 0}] == 2);
  CHECK(at_rest[{"stiffness_factor", 2}] == 24);  // another stiffness each
  CHECK(at_rest[{"rolling_resistance", 1}] == 2);
  CHECK(at_rest[{"end_faces_at_rest", 1}] == 2);  // other walls than the base case, the same among themselves
}

TEST_CASE("no simulation begins in a mill of other walls") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + bank(24, 10));
  for (const PlannedRun& run : planned_runs(q)) {
    if (run.group.starts_with("lifter_face_angle")) CHECK_FALSE(run.simulation.donor);
  }
}

TEST_CASE("the nearest of the ends that are left is taken") {
  const Scratch folder;
  const Question q = question_of(folder, kSections + bank(40, 10));
  const std::vector<BankPoint> base = plan_group(q, {}, 40);
  const std::vector<campaign::Simulation> simulations = simulations_of(q, base, {0});
  const std::vector<naming::Coordinate> theta = q.coordinates();
  std::vector<bool> taken(base.size(), false);
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (i < 2) {
      CHECK_FALSE(simulations[i].donor);
      continue;
    }
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < theta.size(); ++k)
        sum += std::pow(theta[k].coded(base[i].theta[k]) - theta[k].coded(base[j].theta[k]), 2);
      if (!taken[j] && sum < least) least = sum, nearest = j;
    }
    REQUIRE(simulations[i].donor);
    CHECK(simulations[i].donor->settings == simulations[nearest].settings);
    CHECK(value_of(simulations[i].settings, "fill.filling") != value_of(simulations[nearest].settings, "fill.filling"));
    taken[nearest] = true;
  }
}

TEST_CASE("a bank that grows keeps every earlier run with all from which it stems") {
  const Scratch folder;
  const Question small = question_of(folder, kSections + bank(16, 6)), large = question_of(folder, kSections + bank(40, 14));
  std::map<std::pair<std::string, int>, std::vector<std::vector<std::string>>> lines;
  const Planned grown = planned(large), before = planned(small);
  for (std::size_t i = 0; i < grown.points.size(); ++i)
    lines[{grown.points[i].group, grown.points[i].index}] = line_of(grown.simulations[i]);
  std::size_t longest = 0;
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    const auto line = line_of(before.simulations[i]);
    CHECK(lines.at({before.points[i].group, before.points[i].index}) == line);
    longest = std::max(longest, line.size());
  }
  CHECK(longest > 2);
  // What is asked for at once changes nothing: a candidate's first runs before the rest, as a diagnosis does.
  const std::vector<BankPoint> rest = plan_rest(large, 1);
  const std::vector<campaign::Simulation> alone = simulations_of(large, rest, {0});
  for (std::size_t i = 0; i < rest.size(); ++i) CHECK(lines.at({rest[i].group, rest[i].index}) == line_of(alone[i]));
}

TEST_CASE("a time to develop that no condition has room for is refused at its line") {
  const Scratch folder;
  CHECK_THROWS_WITH(question_of(folder, kSections + bank(24, 10, ", develop_turns: 60")),
                    Contains("study.yaml:") && Contains("develop_turns") && Contains("analyze_from_s"));
  CHECK_THROWS_WITH(question_of(folder, kSections + bank(24, 10, ", develop_turns: -1")),
                    Contains("study.yaml:") && Contains("develop_turns"));
  // 3 s are 2.95 turns at 75 %, 1.96 at 50 %.
  CHECK_THROWS_WITH(question_of(folder, kSections + bank(24, 10, ", develop_turns: 2")), Contains("begins after 1.963"));
  CHECK(question_of(folder, kSections + bank(24, 10, ", develop_turns: 1.9")).bank.develop_turns == 1.9);
  CHECK(question_of(folder, kSections + bank(24, 10, ", develop_turns: 0")).bank.develop_turns == 0);
}
