// Sequential design with an emulator, and the search without one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "studies/calibrate/inference.hpp"
#include "studies/calibrate/methods.hpp"
#include "studies/emulate/cma_es.hpp"
#include "studies/emulate/sequential.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

constexpr double kFirstStep = 0.3;  // of the ranges
constexpr int kRunsPerParameter = 10;

/// Parts of Eq. 4.3 for each condition: power (signed, so that it has no kink), x, speed, terms.
constexpr Eigen::Index kParts = 4;

Eigen::VectorXd parts_of(const Evaluator& evaluator, const Trial& trial) {
  Eigen::VectorXd parts(kParts * static_cast<Eigen::Index>(trial.conditions.size()));
  for (std::size_t k = 0; k < trial.conditions.size(); ++k) {
    const Observation& recorded = evaluator.recorded(trial.conditions[k]);
    const ChagasObjective o = chagas2015(recorded, trial.observed[k], evaluator.study().objective.terms);
    parts.segment(kParts * static_cast<Eigen::Index>(k), kParts) << trial.observed[k].power.value - recorded.power.value, o.x, o.speed,
        o.terms;
  }
  return parts;
}

/// An emulator with the objective that is made of what it emulates.
struct Guide {
  emulate::Emulator emulator;
  emulate::Objective objective;
};

Guide chagas_guide(const Evaluator& evaluator, const emulate::Box& box) {
  const std::vector<const Trial*> done = finished(evaluator);
  const auto runs = static_cast<Eigen::Index>(done.size());
  const Eigen::Index all = parts_of(evaluator, *done.front()).size();
  Eigen::MatrixXd output(runs, all);
  emulate::Training training;
  training.input.resize(runs, box.size());
  for (Eigen::Index r = 0; r < runs; ++r) {
    training.input.row(r) = done[r]->point.transpose();
    output.row(r) = parts_of(evaluator, *done[r]).transpose();
  }
  std::vector<Eigen::Index> kept;  // without terms their part is always zero
  for (Eigen::Index i = 0; i < all; ++i) {
    if (output.col(i).maxCoeff() > output.col(i).minCoeff()) kept.push_back(i);
  }
  training.output = output(Eigen::all, kept);
  training.noise_variance = Eigen::MatrixXd::Zero(runs, training.output.cols());
  const double share = static_cast<double>(kParts) / static_cast<double>(all);
  const auto objective = [kept, share](const Eigen::VectorXd& parts) {
    double sum = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) sum += std::fabs(parts[static_cast<Eigen::Index>(i)]);
    return share * sum;
  };
  return {emulate::Emulator::fit(box, training), objective};
}

Guide guide_of(const Evaluator& evaluator, const emulate::Box& box) {
  if (evaluator.study().objective.kind == ObjectiveKind::chagas2015) return chagas_guide(evaluator, box);
  const Fitting f = fitting_of(evaluator);
  emulate::Emulator emulator = emulate::Emulator::fit(box, f.training);
  emulate::Objective objective = emulate::misfit_objective(emulator, f.observed);
  return {std::move(emulator), std::move(objective)};
}

/// The first points, spread over what is allowed.
std::vector<Eigen::VectorXd> spread(const Study& study, int runs) {
  std::vector<doe::Factor> factors;
  for (const Parameter& p : study.parameters) factors.push_back({p.name, 0.5 * (p.low + p.high), 0.5 * (p.high - p.low), ""});
  std::vector<Eigen::VectorXd> points;
  const auto take = [&](const doe::Design& design) {
    for (Eigen::Index r = 0; r < design.coded.rows() && std::ssize(points) < runs; ++r) {
      const Eigen::VectorXd point = doe::natural(factors, design.coded.row(r).transpose());
      if (study.allowed(point) && std::find(points.begin(), points.end(), point) == points.end()) points.push_back(point);
    }
  };
  if (study.design.start == "latin_hypercube") take(doe::latin_hypercube(factors, runs, study.design.seed));
  for (int more = 4 * runs; std::ssize(points) < runs && more <= 1024 * runs; more *= 4) take(doe::sobol(factors, more));
  return points;
}

int start_runs(const Study& study, int budget) {
  const auto parameters = static_cast<int>(study.parameters.size());
  const int wished = study.design.start_runs > 0 ? study.design.start_runs : std::min(budget / 2, kRunsPerParameter * parameters);
  const int runs = std::max(wished, parameters + 3);
  if (runs + 1 > budget) {
    throw UserError(
        study.file.string() +
        fmt::format(": the budget allows {} parameter sets, an emulator of {} parameters needs {} to start with; raise 'budget'", budget,
                    parameters, runs + 1));
  }
  return runs;
}

const Trial* best_of(const Evaluator& evaluator) {
  const Trial* best = nullptr;
  for (const Trial& trial : evaluator.trials()) {
    if (best == nullptr || evaluator.objective(trial) < evaluator.objective(*best)) best = &trial;
  }
  return best;
}

}  // namespace

Calibration by_emulator(Evaluator& evaluator) {
  const Study& study = evaluator.study();
  const emulate::Box box = box_of(study);
  evaluator.evaluate(spread(study, start_runs(study, evaluator.left())), "start");
  for (std::uint64_t round = 1; evaluator.left() > 1; ++round) {
    const Guide guide = guide_of(evaluator, box);
    const int count = std::min(study.design.batch, evaluator.left() - 1);
    const std::size_t before = evaluator.trials().size();
    evaluator.evaluate(emulate::next_points(guide.emulator, box, guide.objective, count, study.design.seed + round),
                       fmt::format("round {}", round));
    if (evaluator.trials().size() == before) break;  // it asks for what is known already
  }
  const Guide guide = guide_of(evaluator, box);
  const emulate::Optimum optimum = emulate::minimise(guide.emulator, box, guide.objective, study.design.seed);
  Calibration c;
  c.best = optimum.point;
  c.predicted = optimum.expected;
  c.how = "the least objective that the emulator expects";
  if (evaluator.left() > 0) c.at_best = evaluator.evaluate(std::vector<Eigen::VectorXd>{c.best}, "optimum").front();
  return c;
}

Calibration by_cma_es(Evaluator& evaluator) {
  const Study& study = evaluator.study();
  const emulate::Box box = box_of(study);
  Eigen::VectorXd start(box.size());
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const Parameter& of = study.parameters[p];
    start[static_cast<Eigen::Index>(p)] = of.centre.value_or(0.5 * (of.low + of.high));
  }
  if (!study.allowed(start)) start = spread(study, 1).front();
  emulate::CmaEs search(box, start, kFirstStep, study.design.seed);
  Calibration c;
  while (search.finished().empty()) {
    const std::vector<Eigen::VectorXd> points = search.ask();
    if (evaluator.left() < static_cast<int>(points.size())) break;
    std::vector<double> values;
    for (const Trial& trial : evaluator.evaluate(points, fmt::format("generation {}", search.generation() + 1)))
      values.push_back(evaluator.objective(trial));
    search.tell(values);
  }
  const Trial* best = best_of(evaluator);
  if (best == nullptr)
    throw UserError(study.file.string() + fmt::format(": the budget allows {} parameter sets, one generation needs {}; raise 'budget'",
                                                      evaluator.left(), search.ask().size()));
  c.best = best->point;
  c.at_best = *best;
  c.predicted = std::numeric_limits<double>::quiet_NaN();
  c.how = search.finished().empty() ? "the best set that was simulated when the budget was spent"
                                    : fmt::format("the best set that was simulated; the search ended: {}", search.finished());
  return c;
}

std::string outside_interval(const std::string& name, const std::string& target, const base::Interval90& found) {
  if (!found.known() || found.holds(found.value)) return "";
  return fmt::format(
      "{}: retuned to {} it is {:.3g}, outside its own interval ({:.3g} … {:.3g}): that moves it where the recordings as a whole do not "
      "want it",
      name, target, found.value, found.low, found.high);
}

std::string contradiction(const Study& study, std::size_t parameter, double best, const emulate::Marginal& marginal) {
  if (study.objective.kind == ObjectiveKind::likelihood) return "";  // both are from the same observables
  // Where the posterior piles up at an end of the range, the end itself lies outside equal tails and contradicts nothing.
  const double low = std::min(marginal.low90, marginal.mode), high = std::max(marginal.high90, marginal.mode);
  if (best >= low && best <= high) return "";
  return outside_interval(study.parameters[parameter].name, fmt::format("the few numbers of {}", name_of(study.objective.kind)),
                          {best, marginal.low90, marginal.high90});
}

Calibration calibrate(Evaluator& evaluator) {
  const Method method = evaluator.study().method;
  Calibration c = method == Method::emulator ? by_emulator(evaluator)
                  : method == Method::cma_es ? by_cma_es(evaluator)
                                             : response_surface(evaluator);
  evaluator.say("posterior of the parameters");
  c.inference = infer(evaluator, c.notes);
  for (std::size_t p = 0; c.inference && p < evaluator.study().parameters.size(); ++p) {
    const std::string said = contradiction(evaluator.study(), p, c.best[static_cast<Eigen::Index>(p)], c.inference->posterior.marginal[p]);
    if (!said.empty()) c.notes.push_back(said);
  }
  std::set<std::filesystem::path> runs;
  for (const Trial& t : evaluator.trials()) runs.insert(t.folders.begin(), t.folders.end());
  c.doubts = campaign::shared_doubts(runs);
  return c;
}

}  // namespace millscope::calibrate
