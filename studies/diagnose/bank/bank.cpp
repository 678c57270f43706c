#include "studies/diagnose/bank/bank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "kernel/base/hash.hpp"
#include "kernel/base/parallel.hpp"
#include "studies/calibrate/observe.hpp"
#include "studies/diagnose/naming/surrogate.hpp"
#include "studies/doe/doe.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kLeastAgain = 8;          // parameter sets, of which chance is told: eight degrees of freedom of each of about 70 observables
constexpr std::size_t kSpareApart = 2;  // runs beyond the coefficients of what is varied apart: linear, square, × every parameter
constexpr int kSeedBits = 53;           // of a run's seed: as many as a whole number of a case may have, so that no two runs share one
constexpr std::uint64_t kOffsets = 16;  // blocks of Sobol's sequence among which groups are spread, of as many points

/// Sobol' points in the unit cube.
MatrixXd unit_points(Index points, Index dimensions) {
  std::vector<doe::Factor> factors;
  for (Index i = 0; i < dimensions; ++i) factors.push_back({fmt::format("u{}", i), 0.5, 0.5, ""});
  return 0.5 * (doe::sobol(std::move(factors), static_cast<int>(points)).coded.array() + 1);
}

std::string name_of(const Question& question, const Group& group) {
  if (group.base()) return "base";
  if (group.nuisance) return question.coordinates()[*group.nuisance].name;
  const std::string& name = question.candidates[*group.candidate].name;
  return group.second ? name + "+" + question.candidates[*group.second].name : name;
}

/// Where a nuisance that is varied apart stands beside a candidate, coded. A case near the middle of the range: its two ends, in Thue's and
/// Morse's order, in which no digit of a Sobol' point goes along with it; else three places of the other half.
double far_from(double usual, int turn) {
  if (std::fabs(usual) < 0.5) return std::popcount(static_cast<unsigned>(turn)) % 2 == 0 ? 1 : -1;
  return std::copysign(std::array{1.0, 0.5, 0.0}[turn % 3], -usual);
}

naming::ActiveCandidate drawn_strength(const Question& question, Index candidate, double unit) {
  const Candidate& c = question.candidates[candidate];
  const double low = c.range.low < 0 ? c.range.low : kLeastStrength;
  return {candidate, rounded_strength(c, c.on_or_off() ? 1 : low + (1 - low) * unit)};
}

/// Coordinates of the case, then what is varied in this group alone (strengths of candidates, a nuisance), then those of the camera.
VectorXd theta_of(const Question& question, const VectorXd& unit, const Group& group) {
  VectorXd theta(question.dimensions());
  const std::vector<naming::Coordinate> coordinates = question.coordinates();
  const Index own = question.case_dimensions();
  Index next = own + group.size();
  for (Index i = 0; i < theta.size(); ++i) {
    const naming::Coordinate& c = coordinates[i];
    if (i == group.nuisance)
      theta[i] = rounded(c.natural(2 * unit[own] - 1));
    else if (c.usual)
      theta[i] = *c.usual;
    else
      theta[i] = rounded(c.low + unit[i < own ? i : next++] * (c.high - c.low));
  }
  return theta;
}

campaign::Simulation simulation(const Question& question, const VectorXd& theta, const std::vector<naming::ActiveCandidate>& active,
                                std::size_t condition) {
  campaign::Simulation s;
  s.case_file = question.study.base;
  s.settings = question.study.conditions[condition].settings;
  for (std::string& setting : question.settings(theta, active)) s.settings.push_back(std::move(setting));
  for (std::string& setting : calibrate::observed_outputs()) s.settings.push_back(std::move(setting));
  return s;
}

void append(std::vector<BankPoint>& to, std::vector<BankPoint> more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Takes out the rows that are so.
template <class Of>
void leave_out_rows(std::vector<naming::BankRow>& rows, std::vector<VectorXd>& values, Of of) {
  for (std::size_t r = rows.size(); r-- > 0;) {
    if (!of(rows[r])) continue;
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(r));
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(r));
  }
}

/// Runs of a candidate with another nuisance that are too few for their product, or stand beside too few without it, would be taken for
/// what the candidate does. One sentence for each candidate that loses runs.
std::vector<std::string> leave_out_too_few(const Question& question, std::vector<naming::BankRow>& rows, std::vector<VectorXd>& values) {
  std::vector<std::string> told;
  for (const Index nuisance : varied_apart(question)) {
    const double usual = *question.coordinates()[nuisance].usual;
    for (Index j = 0; j < std::ssize(question.candidates); ++j) {
      const auto with = [&](const naming::BankRow& row) { return row.candidate() == j && row.active.size() == 1; };
      const auto together = [&](const naming::BankRow& row) { return with(row) && row.theta[nuisance] != usual; };
      const auto runs = std::count_if(rows.begin(), rows.end(), together), all = std::count_if(rows.begin(), rows.end(), with);
      if (runs == 0 || std::min(runs, all - runs) >= naming::kLeastTogether) continue;
      told.push_back(
          fmt::format("{} with another {} was left out: {} and {} simulations with the usual one came to their end, {} of each are needed "
                      "(bank.each; or see why others failed)",
                      question.candidates[j].name, question.coordinates()[nuisance].name, runs, all - runs, naming::kLeastTogether));
      leave_out_rows(rows, values, together);
    }
  }
  return told;
}

/// Runs of two candidates together that are too few for the product of the two would be taken for what each does alone.
void leave_out_few_pairs(const Question& question, std::vector<naming::BankRow>& rows, std::vector<VectorXd>& values,
                         std::vector<std::string>& told) {
  std::map<std::pair<Index, Index>, Index> runs;
  const auto both = [](const naming::BankRow& row) { return std::pair(row.active[0].candidate, row.active[1].candidate); };
  for (const naming::BankRow& row : rows) {
    if (row.active.size() == 2) ++runs[both(row)];
  }
  for (const auto& [pair, count] : runs) {
    if (count >= naming::kLeastTogether) continue;
    told.push_back(fmt::format("{} together with {} was left out: {} simulations of both came to their end, {} are needed",
                               question.candidates[pair.first].name, question.candidates[pair.second].name, count, naming::kLeastTogether));
  }
  leave_out_rows(rows, values,
                 [&](const naming::BankRow& row) { return row.active.size() == 2 && runs.at(both(row)) < naming::kLeastTogether; });
}

/// The surrogate has no other runs that tell what a nuisance does that is varied apart.
void check_varied_apart(const Question& question, const naming::BankData& data) {
  for (const Index nuisance : varied_apart(question)) {
    const naming::Coordinate& c = data.theta[nuisance];
    const std::size_t varied = std::count_if(data.rows.begin(), data.rows.end(), [&](const naming::BankRow& row) {
      return row.active.empty() && row.theta[nuisance] != *c.usual;
    });
    const std::size_t least = 2 + question.study.parameters.size() + kSpareApart;
    if (varied < least)
      throw base::UserError(fmt::format(
          "{} finished simulations of the bank without a candidate vary the nuisance '{}', {} are needed; raise bank.apart, or leave "
          "the nuisance out",
          varied, c.name, least));
  }
}

/// Those with a candidate alone that follow the first `from`, of `count`.
std::vector<BankPoint> plan_next(const Question& question, Index candidate, int from, int count) {
  std::vector<BankPoint> points = plan_group(question, {candidate, {}}, count);
  std::erase_if(points, [&](const BankPoint& p) { return p.index < from; });
  return points;
}

}  // namespace

std::vector<Index> varied_apart(const Question& question) {
  std::vector<Index> out;
  const std::vector<naming::Coordinate> coordinates = question.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].usual) out.push_back(i);
  }
  return out;
}

std::vector<BankPoint> plan_group(const Question& question, const Group& of, int count) {
  const std::string group = name_of(question, of);
  const auto offset = of.base() ? 0 : static_cast<Index>(kOffsets * (base::Hash().add(group).value() % kOffsets));
  const Index d = question.dimensions() - varied_apart(question).size();
  const MatrixXd unit = unit_points(offset + count, d + of.size());
  std::vector<BankPoint> points;
  for (int i = 0; i < count; ++i) {
    const VectorXd u = unit.row(offset + i).transpose();
    BankPoint point{group, i, theta_of(question, u, of), {}};
    if (of.candidate) point.active.push_back(drawn_strength(question, *of.candidate, u[question.case_dimensions()]));
    if (of.second) point.active.push_back(drawn_strength(question, *of.second, u[question.case_dimensions() + 1]));
    if (question.study.allowed(point.theta.head(std::ssize(question.study.parameters)))) points.push_back(std::move(point));
  }
  return points;
}

std::vector<BankPoint> plan_again(const Question& question) {
  std::vector<BankPoint> points = plan_group(question, {}, std::max(kLeastAgain, question.bank.base / 2));
  for (BankPoint& p : points) p.group = "again";
  return points;
}

std::vector<BankPoint> plan_screening(const Question& question) {
  std::vector<BankPoint> all = plan_group(question, {}, question.bank.base);
  append(all, plan_again(question));
  for (const Index nuisance : varied_apart(question)) append(all, plan_group(question, {{}, nuisance}, question.bank.apart));
  for (Index j = 0; j < std::ssize(question.candidates); ++j)
    append(all, plan_group(question, {j, {}}, std::min(question.bank.first, question.bank.each)));
  return all;
}

std::vector<BankPoint> plan_together(const Question& question, Index candidate, Index nuisance) {
  const naming::Coordinate c = question.coordinates()[nuisance];
  const int pairs = (question.bank.each + 1) / 2;
  std::vector<BankPoint> all;
  for (BankPoint& p : plan_group(question, {candidate, {}}, 2 * pairs)) {
    const bool second = p.index % 2 != 0 && !all.empty() && all.back().index == p.index / 2;
    p.index /= 2;
    if (second) {
      const double before = std::fabs(all.back().active[0].strength), now = std::fabs(p.active[0].strength);
      if (now < before || (now == before && std::popcount(static_cast<unsigned>(p.index)) % 2 == 0)) continue;
      all.pop_back();
    }
    p.group += "*" + c.name;
    p.theta[nuisance] = rounded(c.natural(far_from(c.coded(*c.usual), p.index)));
    all.push_back(std::move(p));
  }
  if (std::ssize(all) < naming::kLeastTogether) all.clear();
  return all;
}

std::vector<BankPoint> plan_rest(const Question& question, Index candidate) {
  std::vector<BankPoint> all = plan_next(question, candidate, question.bank.first, question.bank.each);
  for (const Index nuisance : varied_apart(question)) append(all, plan_together(question, candidate, nuisance));
  return all;
}

std::vector<BankPoint> plan_more(const Question& question, Index candidate) {
  return plan_next(question, candidate, question.bank.each, 2 * question.bank.each);
}

std::vector<BankPoint> plan_pair(const Question& question, Index one, Index other) {
  if (question.candidates[other].name < question.candidates[one].name) std::swap(one, other);
  return plan_group(question, {.candidate = one, .second = other}, question.bank.each);
}

std::vector<BankPoint> plan_bank(const Question& question) {
  std::vector<BankPoint> all = plan_screening(question);
  for (Index j = 0; j < std::ssize(question.candidates); ++j) append(all, plan_rest(question, j));
  return all;
}

/// How few are too few is a rule of thumb: what the surrogate then errs by is counted wherever it is used.
std::vector<BankPoint> held_out_points(const Question& question, std::vector<BankPoint> points, const AskedCandidates& asked) {
  constexpr Index kEnough = 2;  // parameter sets for each coefficient of the base
  naming::BankData data;
  data.theta = question.coordinates();
  const Index needed = kEnough * naming::Features(data).base_size() + asked.coefficients;
  const auto is_asked = [&](const BankPoint& p) {
    return std::all_of(p.active.begin(), p.active.end(), [&](const auto& on) { return asked.which.count(on.candidate) == 1; });
  };
  const auto tells = [&](const BankPoint& p) { return is_asked(p) && p.group != "again"; };
  if (std::count_if(points.begin(), points.end(), tells) >= needed) std::erase_if(points, [&](const BankPoint& p) { return !is_asked(p); });
  return points;
}

campaign::Simulation simulation_of(const Question& question, const BankPoint& point, std::size_t condition) {
  const std::string& name = question.study.conditions[condition].name;
  campaign::Simulation s = simulation(question, point.theta, point.active, condition);
  const std::uint64_t own = base::Hash().add(fmt::format("{}/{}/{}", point.group, name, point.index)).value();
  s.settings.push_back(fmt::format("seed={}", own >> (64 - kSeedBits)));
  s.label = fmt::format("{}_{}_{}", point.group, point.index, name);
  return s;
}

campaign::Simulation simulation_at(const Question& question, const VectorXd& theta, const std::vector<naming::ActiveCandidate>& active,
                                   std::size_t condition, int replicate, const std::string& label) {
  campaign::Simulation s = simulation(question, theta, active, condition);
  s.settings.push_back(fmt::format("seed={}", 7919 * replicate + 17));
  s.label = fmt::format("{}, seed {}, {}", label, replicate, question.study.conditions[condition].name);
  return s;
}

calibrate::Observation Evidence::look(const calibrate::Machinery& machinery, const Question& question, std::size_t condition,
                                      const campaign::Outcome& outcome, const VectorXd& theta) const {
  if (outcome.state == campaign::State::failed) throw base::UserError(outcome.message);
  calibrate::Observation o = machinery.observe(condition, outcome, question.camera(theta));
  if (!readings.empty()) add_readings(question, readings[condition], theta, o);
  if (!without.empty()) calibrate::leave_out(o, without[condition]);
  return o;
}

Bank fill_bank(const Question& question, const calibrate::Machinery& machinery, const Evidence& evidence, std::vector<BankPoint> points,
               std::vector<std::size_t> conditions) {
  const std::vector<campaign::Simulation> simulations = simulations_of(question, points, conditions);
  const std::vector<campaign::Outcome> outcomes = machinery.run(simulations);
  machinery.say(fmt::format("looking at {} simulations through the recordings' cameras", outcomes.size()));
  Bank bank{std::move(points), std::move(conditions), {}, {}, {}};
  const std::size_t per_point = bank.conditions.size();
  bank.runs.resize(bank.points.size());
  for (std::size_t i = 0; i < outcomes.size(); ++i) bank.runs[i / per_point].push_back(outcomes[i].folder);
  bank.seen.assign(bank.points.size(), std::vector<std::optional<calibrate::Observation>>(per_point));
  std::vector<std::string> failures(outcomes.size());
  // Whole simulations side by side: looking at one is half of it a single thread's work.
  base::for_each_item(outcomes.size(), base::worker_count(0, outcomes.size()), [&](std::size_t i, std::size_t) {
    try {
      bank.seen[i / per_point][i % per_point] =
          evidence.look(machinery, question, bank.conditions[i % per_point], outcomes[i], bank.points[i / per_point].theta);
    } catch (const base::UserError& e) {
      failures[i] = fmt::format("{}: {}", simulations[i].label, e.what());
    }
  });
  std::copy_if(failures.begin(), failures.end(), std::back_inserter(bank.failures), [](const std::string& f) { return !f.empty(); });
  return bank;
}

Bank joined(Bank bank, const Bank& more) {
  std::map<std::pair<std::string, int>, std::size_t> place;
  for (std::size_t p = 0; p < more.points.size(); ++p) place[{more.points[p].group, more.points[p].index}] = p;
  for (std::size_t p = 0; p < bank.points.size(); ++p) {
    const auto found = place.find({bank.points[p].group, bank.points[p].index});
    const bool known = found != place.end();
    for (std::size_t k = 0; k < more.conditions.size(); ++k) {
      bank.seen[p].push_back(known ? more.seen[found->second][k] : std::nullopt);
      bank.runs[p].push_back(known ? more.runs[found->second][k] : std::filesystem::path());
    }
  }
  bank.conditions.insert(bank.conditions.end(), more.conditions.begin(), more.conditions.end());
  bank.failures.insert(bank.failures.end(), more.failures.begin(), more.failures.end());
  return bank;
}

naming::BankData data_of(const Question& question, const Bank& bank, const std::vector<std::size_t>& conditions) {
  naming::BankData data;
  data.theta = question.coordinates();
  data.candidates = std::ssize(question.candidates);
  std::vector<VectorXd> values;
  for (std::size_t p = 0; p < bank.points.size(); ++p) {
    std::vector<double> row;
    bool whole = true;
    for (const std::size_t c : conditions) {
      const auto& seen = bank.seen[p][bank.place_of(c).value()];
      if (!seen) {
        whole = false;
        break;
      }
      row.insert(row.end(), seen->value.data(), seen->value.data() + seen->value.size());
      if (values.empty() && data.condition.size() < row.size()) data.condition.resize(row.size(), c);
    }
    if (!whole) continue;
    data.rows.push_back({bank.points[p].theta, bank.points[p].active});
    values.emplace_back(Eigen::Map<const VectorXd>(row.data(), std::ssize(row)));
  }
  data.left_out = leave_out_too_few(question, data.rows, values);
  leave_out_few_pairs(question, data.rows, values, data.left_out);
  if (!bank.failures.empty())
    data.left_out.insert(data.left_out.begin(), fmt::format("{} simulations of the bank failed and are left out, the first: {}",
                                                            bank.failures.size(), bank.failures.front()));
  if (values.empty()) {
    throw base::UserError(fmt::format("no simulation of the bank has come to its end{}{}; correct the base case or the ranges",
                                      bank.failures.empty() ? "" : "; the first: ", bank.failures.empty() ? "" : bank.failures.front()));
  }
  data.value.resize(std::ssize(values), values.front().size());
  for (std::size_t r = 0; r < values.size(); ++r) data.value.row(r) = values[r].transpose();
  check_varied_apart(question, data);
  return data;
}

}  // namespace millscope::diagnose
