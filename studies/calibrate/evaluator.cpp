#include "studies/calibrate/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/calibrate/observe.hpp"
#include "studies/calibrate/power.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

std::string point_text(const Study& study, const Eigen::VectorXd& point) {
  std::string text;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    text += fmt::format("{}{} {:.4g}", i > 0 ? ", " : "", study.parameters[i].name, point[static_cast<Eigen::Index>(i)]);
  }
  return text;
}

campaign::Simulation simulation(const Study& study, const Eigen::VectorXd& point, int replicate, std::size_t condition) {
  campaign::Simulation s;
  s.case_file = study.base;
  s.settings = study.conditions[condition].settings;
  for (std::string& setting : settings_of(study, point)) s.settings.push_back(std::move(setting));
  for (std::string& setting : observed_outputs()) s.settings.push_back(std::move(setting));
  if (replicate > 0) s.settings.push_back(fmt::format("seed={}", 7919 * replicate + 17));
  s.label = fmt::format("{}: {}{}", study.conditions[condition].name, point_text(study, point),
                        replicate > 0 ? fmt::format(", seed {}", replicate) : "");
  return s;
}

/// Eq. 4.3 compares distributions: its mean is that over the conditions that have some.
void score(const Study& study, const std::vector<Observation>& recorded, Trial& trial) {
  const auto tracks =
      std::count_if(trial.conditions.begin(), trial.conditions.end(), [&](std::size_t c) { return recorded[c].of_tracks(); });
  for (std::size_t k = 0; k < trial.conditions.size(); ++k) {
    const Observation& of = recorded[trial.conditions[k]];
    trial.misfit += misfit(of, trial.observed[k]);
    if (!of.of_tracks()) continue;
    const double share = 1.0 / static_cast<double>(tracks);
    const ChagasObjective one = chagas2015(of, trial.observed[k], study.objective.terms);
    trial.chagas.power += share * one.power;
    trial.chagas.x += share * one.x;
    trial.chagas.speed += share * one.speed;
    trial.chagas.terms += share * one.terms;
  }
  if (!std::isfinite(trial.misfit) || !std::isfinite(trial.chagas.value())) {
    trial.failed = true;
    trial.message = "its observables are not finite";
  }
}

}  // namespace

Evaluator::Evaluator(const Study& study, Machinery machinery, std::vector<Observation> recorded)
    : study_(study), machinery_(std::move(machinery)), recorded_(std::move(recorded)) {
  for (Observation& of : recorded_) add_power_error(of, study_.power_error);
}

double Evaluator::objective(const Trial& trial) const {
  if (trial.failed) return std::numeric_limits<double>::infinity();
  return study_.objective.kind == ObjectiveKind::chagas2015 ? trial.chagas.value() : trial.misfit;
}

int Evaluator::left() const {
  const auto per_set = static_cast<int>(study_.with_role(Role::fit).size());
  int sets = (study_.budget.simulations - simulations_) / per_set;
  if (study_.budget.wall > 0 && simulations_ > 0) {
    const double spent = wall_ / machinery_.slots, each = spent / simulations_ * per_set;
    sets = std::min(sets, each > 0 ? static_cast<int>((study_.budget.wall - spent) / each) : sets);
  }
  return std::max(0, sets);
}

const Trial* Evaluator::known(const Wanted& wanted) const {
  const auto found = std::find_if(trials_.begin(), trials_.end(),
                                  [&](const Trial& t) { return t.replicate == wanted.replicate && t.point == wanted.point; });
  return found == trials_.end() ? nullptr : &*found;
}

Trial Evaluator::look(const Job& job, std::span<const campaign::Outcome> outcomes) const {
  Trial trial;
  trial.point = job.wanted.point;
  trial.replicate = job.wanted.replicate;
  trial.conditions = job.conditions;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    trial.wall_s += outcomes[k].wall_s;
    trial.folders.push_back(outcomes[k].folder);
    if (trial.failed) continue;
    try {
      if (outcomes[k].state == campaign::State::failed) throw UserError(outcomes[k].message);
      Observation seen = machinery_.observe(job.conditions[k], outcomes[k], {});
      require_defined(seen);
      trial.observed.push_back(std::move(seen));
    } catch (const UserError& e) {
      trial.failed = true;
      trial.message = fmt::format("condition '{}': {}", study_.conditions[job.conditions[k]].name, e.what());
    }
  }
  if (!trial.failed) score(study_, recorded_, trial);
  if (trial.failed) say(fmt::format("left out: {} ({})", point_text(study_, trial.point), trial.message));
  return trial;
}

std::vector<Trial> Evaluator::run(const std::vector<Job>& jobs, const std::string& stage) const {
  std::vector<campaign::Simulation> simulations;
  for (const Job& job : jobs) {
    for (const std::size_t c : job.conditions) simulations.push_back(simulation(study_, job.wanted.point, job.wanted.replicate, c));
  }
  const std::vector<campaign::Outcome> outcomes = machinery_.run(simulations);
  std::vector<Trial> done;
  std::size_t next = 0;
  for (const Job& job : jobs) {
    done.push_back(look(job, std::span(outcomes).subspan(next, job.conditions.size())));
    done.back().stage = stage;
    next += job.conditions.size();
  }
  return done;
}

std::vector<Trial> Evaluator::evaluate(const std::vector<Wanted>& wanted, const std::string& stage) {
  std::vector<Wanted> fresh;
  for (const Wanted& w : wanted) {
    const bool twice =
        std::any_of(fresh.begin(), fresh.end(), [&](const Wanted& f) { return f.replicate == w.replicate && f.point == w.point; });
    if (known(w) == nullptr && !twice) fresh.push_back(w);
  }
  const std::vector<std::size_t> conditions = study_.with_role(Role::fit);
  if (!fresh.empty()) {
    say(fmt::format("{}: {} parameter sets ({} of {} simulations used so far)", stage, fresh.size(), simulations_,
                    study_.budget.simulations));
    std::vector<Job> jobs;
    for (const Wanted& w : fresh) jobs.push_back({w, conditions});
    for (Trial& trial : run(jobs, stage)) {
      simulations_ += static_cast<int>(conditions.size());
      wall_ += trial.wall_s;
      trials_.push_back(std::move(trial));
    }
  }
  if (!trials_.empty() && std::all_of(trials_.begin(), trials_.end(), [](const Trial& t) { return t.failed; })) {
    throw UserError(fmt::format(
        "all {} simulations have failed, the first so: {}; nothing is lost: correct the base case or the ranges and start again",
        simulations_, trials_.front().message));
  }
  std::vector<Trial> all;
  for (const Wanted& w : wanted) all.push_back(*known(w));
  return all;
}

std::vector<Trial> Evaluator::evaluate(const std::vector<Eigen::VectorXd>& points, const std::string& stage) {
  std::vector<Wanted> wanted;
  for (const Eigen::VectorXd& point : points) wanted.push_back({point, 0});
  return evaluate(wanted, stage);
}

std::vector<std::pair<std::size_t, Trial>> Evaluator::each_in(const Eigen::VectorXd& point,
                                                              const std::vector<std::size_t>& conditions) const {
  std::vector<Job> jobs;
  const Wanted wanted{point, 0};
  for (const std::size_t c : conditions) jobs.push_back({wanted, {c}});
  std::vector<Trial> trials = run(jobs, "validation");
  std::vector<std::pair<std::size_t, Trial>> each;
  for (std::size_t i = 0; i < trials.size(); ++i) each.emplace_back(conditions[i], std::move(trials[i]));
  return each;
}

}  // namespace millscope::calibrate
