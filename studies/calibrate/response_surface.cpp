// The chain of Chagas 2015: screening, descent, central composite design, surface, optimum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/calibrate/methods.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

constexpr double kDescentStep = 0.5;  // of the screening's step, in the factor with the largest effect
constexpr int kShrinkages = 6;

double centre_of(const Parameter& p) { return p.centre.value_or(0.5 * (p.low + p.high)); }
double step_of(const Parameter& p) { return p.spread.value_or(0.25 * (p.high - p.low)); }

/// Rows of a design as full parameter sets; factors that are not in it stay at `others`.
std::vector<Eigen::VectorXd> points_of(const doe::Design& design, const std::vector<std::size_t>& parameters,
                                       const Eigen::VectorXd& others) {
  std::vector<Eigen::VectorXd> points;
  for (Eigen::Index r = 0; r < design.coded.rows(); ++r) {
    const Eigen::VectorXd natural = doe::natural(design.factors, design.coded.row(r).transpose());
    Eigen::VectorXd point = others;
    for (std::size_t f = 0; f < parameters.size(); ++f)
      point[static_cast<Eigen::Index>(parameters[f])] = natural[static_cast<Eigen::Index>(f)];
    points.push_back(std::move(point));
  }
  return points;
}

/// Runs a design; centre points get other seeds, so that they show pure error.
RunDesign run_design(Evaluator& evaluator, const doe::Design& design, const std::vector<std::size_t>& parameters,
                     const Eigen::VectorXd& others, const std::string& stage) {
  const std::vector<Eigen::VectorXd> points = points_of(design, parameters, others);
  std::vector<Evaluator::Wanted> wanted;
  int centre = 0;
  for (std::size_t r = 0; r < points.size(); ++r) wanted.push_back({points[r], design.kind[r] == "centre" ? centre++ : 0});
  const std::vector<Trial> trials = evaluator.evaluate(wanted, stage);
  RunDesign run{design, parameters, {}, {}};
  std::vector<Eigen::Index> rows;
  run.design.kind.clear();
  std::vector<double> response;
  for (std::size_t r = 0; r < trials.size(); ++r) {
    if (trials[r].failed) continue;
    rows.push_back(static_cast<Eigen::Index>(r));
    run.design.kind.push_back(design.kind[r]);
    run.trials.push_back(trials[r]);
    response.push_back(evaluator.objective(trials[r]));
  }
  run.design.coded = design.coded(rows, Eigen::all);
  run.response = Eigen::Map<const Eigen::VectorXd>(response.data(), static_cast<Eigen::Index>(response.size()));
  return run;
}

void require_allowed(const Study& study, const std::vector<Eigen::VectorXd>& points, const char* what) {
  for (const Eigen::VectorXd& point : points) {
    for (const Constraint& c : study.constraints) {
      if (!c.holds(point))
        throw UserError(study.parameters.front().where, fmt::format("a run of the {} breaks the constraint '{}'; give the parameters a "
                                                                    "'centre' and 'step' that keep it, or choose 'method: emulator'",
                                                                    what, c.text));
    }
  }
}

int composite_runs(const Study& study) {
  const int k = std::min(study.design.kept_factors, static_cast<int>(study.parameters.size()));
  return (1 << k) + 2 * k + study.design.composite_centre_points;
}

Screening screen(Evaluator& evaluator, const Eigen::VectorXd& centre) {
  const Study& study = evaluator.study();
  std::vector<doe::Factor> factors;
  std::vector<std::size_t> all(study.parameters.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const Parameter& p : study.parameters) factors.push_back({p.name, centre_of(p), step_of(p), ""});
  const doe::Design design = doe::two_level(factors, study.design.generators, study.design.screening_centre_points);
  require_allowed(study, points_of(design, all, centre), "screening design");
  const auto needed = static_cast<int>(design.coded.rows()) + composite_runs(study);
  if (evaluator.left() < needed) {
    throw UserError(study.file.string() +
                    fmt::format(": the budget allows {} parameter sets, screening and central composite design need {}; raise 'budget'",
                                evaluator.left(), needed));
  }
  Screening s{run_design(evaluator, design, all, centre, "screening"), {}, {}};
  s.anova = doe::analyze_two_level(s.run.design, s.run.response);
  std::vector<std::size_t> order = all;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::fabs(s.anova.effects[a].value) > std::fabs(s.anova.effects[b].value); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(study.design.kept_factors)));
  s.kept = order;
  return s;
}

bool inside(const Study& study, const Eigen::VectorXd& point) {
  return (point.array() >= study.low().array()).all() && (point.array() <= study.high().array()).all() && study.allowed(point);
}

/// Down the gradient until it goes up again; returns the best point met.
Eigen::VectorXd descend(Evaluator& evaluator, const Screening& s, std::vector<Trial>& path) {
  const Study& study = evaluator.study();
  Eigen::VectorXd best = doe::natural(s.anova.factors, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(study.parameters.size())));
  double least = 0;
  int centres = 0;
  for (std::size_t r = 0; r < s.run.trials.size(); ++r) {
    if (s.run.design.kind[r] == "centre") least += s.run.response[static_cast<Eigen::Index>(r)], ++centres;
  }
  least = centres > 0 ? least / centres : s.anova.mean;
  const int steps = std::min(study.design.descent_steps, evaluator.left() - composite_runs(study));
  if (steps < 1) return best;
  std::vector<Eigen::VectorXd> points;
  for (const Eigen::VectorXd& coded : doe::steepest_descent(s.anova, kDescentStep, steps)) {
    const Eigen::VectorXd point = doe::natural(s.anova.factors, coded);
    if (!inside(study, point)) break;
    if (coded.norm() > 0) points.push_back(point);
  }
  for (std::size_t begin = 0; begin < points.size();) {
    const std::size_t end = std::min(points.size(), begin + static_cast<std::size_t>(study.design.batch));
    bool better = false;
    for (const Trial& trial : evaluator.evaluate(std::vector<Eigen::VectorXd>(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                                                              points.begin() + static_cast<std::ptrdiff_t>(end)),
                                                 "descent")) {
      path.push_back(trial);
      if (!(evaluator.objective(trial) < least)) continue;
      least = evaluator.objective(trial);
      best = trial.point;
      better = true;
    }
    if (!better) break;
    begin = end;
  }
  return best;
}

/// A central composite design about `centre` that stays in the ranges and keeps the constraints.
doe::Design composite_about(const Study& study, const std::vector<std::size_t>& kept, Eigen::VectorXd& centre) {
  const auto k = static_cast<int>(kept.size());
  const double axial = study.design.axial == "rotatable" ? doe::rotatable(k) : doe::kFaceCentred;
  double shrink = 1;
  for (int i = 0; i < kShrinkages; ++i, shrink /= 2) {
    std::vector<doe::Factor> factors;
    Eigen::VectorXd moved = centre;
    for (const std::size_t f : kept) {
      const Parameter& p = study.parameters[f];
      const double step = std::min(shrink * study.design.composite_step * step_of(p), (p.high - p.low) / (2 * axial));
      double& middle = moved[static_cast<Eigen::Index>(f)];
      middle = std::clamp(middle, p.low + axial * step, p.high - axial * step);
      factors.push_back({p.name, middle, step, ""});
    }
    doe::Design design = doe::central_composite(factors, axial, study.design.composite_centre_points);
    const std::vector<Eigen::VectorXd> points = points_of(design, kept, moved);
    if (i + 1 == kShrinkages) require_allowed(study, points, "central composite design");
    if (!std::all_of(points.begin(), points.end(), [&](const Eigen::VectorXd& p) { return study.allowed(p); })) continue;
    centre = moved;
    return design;
  }
  return {};
}

}  // namespace

Calibration response_surface(Evaluator& evaluator) {
  const Study& study = evaluator.study();
  if (study.parameters.size() < 2)
    throw UserError(study.parameters.front().where,
                    "method response_surface needs at least two parameters; choose 'method: emulator' or 'cma_es'");
  Calibration c;
  Eigen::VectorXd centre(static_cast<Eigen::Index>(study.parameters.size()));
  for (std::size_t p = 0; p < study.parameters.size(); ++p) centre[static_cast<Eigen::Index>(p)] = centre_of(study.parameters[p]);
  c.screening = screen(evaluator, centre);
  centre = descend(evaluator, *c.screening, c.descent);
  const doe::Design design = composite_about(study, c.screening->kept, centre);
  c.composite = Composite{run_design(evaluator, design, c.screening->kept, centre, "central composite"), {}};
  doe::Surface& surface = c.composite->surface;
  surface = doe::fit_surface(c.composite->run.design, c.composite->run.response);
  const auto& stationary = surface.stationary;
  const bool minimum = stationary && stationary->kind == doe::StationaryKind::minimum && stationary->inside;
  const Eigen::VectorXd coded = minimum ? stationary->coded : doe::least_within(surface, surface.lower, surface.upper);
  const Eigen::VectorXd natural = doe::natural(surface.factors, coded);
  c.best = centre;
  for (std::size_t f = 0; f < c.screening->kept.size(); ++f)
    c.best[static_cast<Eigen::Index>(c.screening->kept[f])] = natural[static_cast<Eigen::Index>(f)];
  c.predicted = doe::value_at(surface, coded);
  c.how = minimum ? "the minimum of the quadratic surface"
                  : "the least value of the quadratic surface within the runs' range: it has no minimum there";
  if (!study.allowed(c.best)) c.notes.push_back("the surface's optimum breaks a constraint: take it for a direction, not for a set");
  if (evaluator.left() > 0) c.at_best = evaluator.evaluate(std::vector<Eigen::VectorXd>{c.best}, "optimum").front();
  return c;
}

}  // namespace millscope::calibrate
