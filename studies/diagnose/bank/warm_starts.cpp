// Which simulation of the bank begins at which other one's end.
//
// Each gives its end to one other at most, so that no two share a start. A donor is an earlier one of the same group and condition, of the
// same mill and the same beads: the plan of a group says it alone, so that a bank grows without losing a run. A group begins with kChains
// simulations from rest; from then on there are as many ends to choose from, of which the nearest in the parameters is taken, and as many
// simulations that need not wait for each other.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "studies/diagnose/bank/beyond.hpp"

namespace millscope::diagnose {
namespace {

constexpr std::size_t kChains = 2;

/// What may differ between a simulation and its donor: no wall, no motion, no size of a bead; and no stiffness, for overlaps of soft
/// contacts are springs under load in stiff ones, and nobody has tried how soon that is forgotten.
constexpr std::array kFree = {
    "pairs.", "contact.", "body_forces.", "fill.filling=", "fill.count=", "fill.mass=", "time.", "output.", "seed="};

/// Of a simulation, what its donor has to have, too.
std::string mill_of(const campaign::Simulation& simulation) {
  std::string text;
  for (const std::string& setting : simulation.settings) {
    if (std::none_of(kFree.begin(), kFree.end(), [&](const char* path) { return setting.starts_with(path); })) text += setting + "\n";
  }
  return text;
}

/// Square of the distance in coded parameters, the candidate's strength among them.
double distance2(const Question& question, const BankPoint& one, const BankPoint& other) {
  const std::vector<naming::Coordinate> coordinates = question.coordinates();
  const std::size_t parameters = question.study.parameters.size();
  double sum = 0;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (i >= parameters && question.nuisances[i - parameters].of_camera()) continue;
    const double d = coordinates[i].coded(one.theta[i]) - coordinates[i].coded(other.theta[i]);
    sum += d * d;
  }
  for (std::size_t k = 0; k < std::min(one.active.size(), other.active.size()); ++k) {
    const double d = 2 * (one.active[k].strength - other.active[k].strength);  // as a coded value, which goes from -1 to 1
    sum += d * d;
  }
  return sum;
}

/// All points of a group up to an index.
std::vector<BankPoint> group_of(const Question& question, const std::string& name, int last) {
  if (name == "base") return plan_group(question, {}, last + 1);
  if (name == "again") return plan_again(question);
  const std::vector<naming::Coordinate> coordinates = question.coordinates();
  for (const Index nuisance : varied_apart(question)) {
    if (name == coordinates[nuisance].name) return plan_group(question, {{}, nuisance}, last + 1);
  }
  for (Index j = 0; j < std::ssize(question.candidates); ++j) {
    const std::string& candidate = question.candidates[j].name;
    if (name == candidate) return plan_group(question, {j, {}}, last + 1);
    for (Index k = 0; k < std::ssize(question.candidates); ++k) {
      if (name == candidate + "+" + question.candidates[k].name) return plan_group(question, {.candidate = j, .second = k}, last + 1);
    }
    for (const Index nuisance : varied_apart(question)) {
      if (name == candidate + "*" + coordinates[nuisance].name) return plan_together(question, j, nuisance);
    }
  }
  throw base::UserError(fmt::format("the bank has no group '{}'", name));
}

using Chain = std::map<int, std::shared_ptr<const campaign::Simulation>>;  // by index in the group

/// The simulations of a group in one condition.
Chain chain_of(const Question& question, const std::vector<BankPoint>& group, std::size_t condition) {
  struct End {
    const BankPoint* point;
    std::string mill;
    std::shared_ptr<const campaign::Simulation> simulation;
  };
  std::vector<End> ends;  // that nobody has taken
  Chain chain;
  for (const BankPoint& point : group) {
    auto own = std::make_shared<campaign::Simulation>(simulation_of(question, point, condition));
    const std::string mill = mill_of(*own);
    std::vector<End>::iterator nearest = ends.end();
    double least = std::numeric_limits<double>::infinity();
    std::size_t count = 0;
    for (auto end = ends.begin(); end != ends.end(); ++end) {
      if (end->mill != mill) continue;
      ++count;
      if (const double d = distance2(question, *end->point, point); d < least) least = d, nearest = end;
    }
    if (count >= kChains) {
      own->donor = nearest->simulation;
      own->develop_s = std::floor(1e4 * question.bank.develop_turns * 2 * std::numbers::pi / question.speed[condition]) / 1e4;
      ends.erase(nearest);
    }
    ends.push_back({&point, mill, own});
    chain[point.index] = std::move(own);
  }
  return chain;
}

}  // namespace

std::vector<campaign::Simulation> simulations_of(const Question& question, const std::vector<BankPoint>& points,
                                                 const std::vector<std::size_t>& conditions) {
  std::map<std::string, int> last;
  for (const BankPoint& p : points) last[p.group] = std::max(last[p.group], p.index);
  std::map<std::pair<std::string, std::size_t>, Chain> chains;
  if (question.bank.develop_turns > 0) {
    for (const auto& [name, index] : last) {
      if (is_beyond(name)) continue;  // few, and far from others in what they vary: from rest
      const std::vector<BankPoint> group = group_of(question, name, index);
      for (const std::size_t c : conditions) chains[{name, c}] = chain_of(question, group, c);
    }
  }
  std::vector<campaign::Simulation> simulations;
  for (const BankPoint& p : points) {
    for (const std::size_t c : conditions) {
      const auto chain = chains.find({p.group, c});
      simulations.push_back(chain == chains.end() ? simulation_of(question, p, c) : *chain->second.at(p.index));
    }
  }
  return simulations;
}

}  // namespace millscope::diagnose
