// Two-level plans: effects, analysis of variance, steepest descent.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "kernel/base/error.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/doe/words.hpp"

namespace millscope::doe {
namespace {

using base::UserError;
using Index = Eigen::Index;

constexpr double kOnLevel = 1e-9;

/// Which runs are centre runs; throws unless every other one lies on the two levels of all factors.
std::vector<bool> centre_runs(const Design& design) {
  std::vector<bool> centre;
  for (Index run = 0; run < design.coded.rows(); ++run) {
    centre.push_back(design.coded.row(run).cwiseAbs().maxCoeff() < kOnLevel);
    for (Index i = 0; i < design.coded.cols() && !centre.back(); ++i) {
      if (std::abs(std::abs(design.coded(run, i)) - 1) < kOnLevel) continue;
      throw UserError(fmt::format("run {}: {} at coded {:.4g} is neither -1 nor +1; a second-order fit (quadratic) takes such plans",
                                  run + 1, design.factors[i].name, design.coded(run, i)));
    }
  }
  return centre;
}

/// The factorial runs, and what they cannot tell apart.
struct Plan {
  std::vector<bool> centre;
  bool has_centre = false;
  std::vector<Word> relation;
  std::vector<std::vector<Word>> chains;
  bool irregular = false;
};

Plan plan_of(const Design& design) {
  Plan plan;
  plan.centre = centre_runs(design);
  Eigen::MatrixXd signs(design.coded.rows(), design.coded.cols());
  Index runs = 0;
  for (Index run = 0; run < design.coded.rows(); ++run) {
    if (!plan.centre[run]) signs.row(runs++) = design.coded.row(run);
  }
  plan.has_centre = runs < design.coded.rows();
  if (runs == 0) throw UserError("all runs are centre runs; add runs at the two levels");
  const std::vector<Word> words = constant_words(signs.topRows(runs));
  if (words.size() > 16)
    throw UserError(fmt::format("{} factors in {} runs: more than 16 generators; leave factors out", signs.cols(), runs));
  plan.relation = closure(words);
  plan.chains = chains(static_cast<int>(design.coded.cols()), plan.relation);
  plan.irregular = !is_regular(signs.topRows(runs), static_cast<int>(words.size()));
  return plan;
}

Eigen::VectorXd column_of(const Design& design, Word word) {
  Eigen::VectorXd column = Eigen::VectorXd::Ones(design.coded.rows());
  for (const int i : members(word)) column.array() *= design.coded.col(i).array();
  return column;
}

/// 1, the terms, and the step between factorial and centre runs.
struct Model {
  Eigen::MatrixXd matrix;
  std::vector<std::string> names;
};

Model model_of(const Design& design, const Plan& plan, const std::vector<Effect>& effects, bool with_pooled) {
  Model model{Eigen::MatrixXd::Ones(design.coded.rows(), 1), {"the mean"}};
  const auto add = [&model](const Eigen::VectorXd& column, const std::string& name) {
    model.matrix.conservativeResize(Eigen::NoChange, model.matrix.cols() + 1);
    model.matrix.rightCols(1) = column;
    model.names.push_back(name);
  };
  for (const Effect& effect : effects) {
    if (effect.pooled && !with_pooled) continue;
    Word word;
    for (const int i : effect.factors) word.factors |= 1u << i;
    add(column_of(design, word), effect.name);
  }
  if (plan.has_centre) {
    Eigen::VectorXd centre(design.coded.rows());
    for (Index run = 0; run < centre.size(); ++run) centre[run] = plan.centre[run] ? 1 : 0;
    add(centre, "curvature");
  }
  return model;
}

std::vector<Effect> effects_of(const Design& design, const Plan& plan, TwoLevelModel model) {
  std::vector<Effect> effects;
  for (const auto& chain : plan.chains) {
    Effect effect;
    effect.factors = members(chain[0]);
    effect.name = text_of(chain[0], design.factors);
    effect.alias = text_of(chain, design.factors, true);
    effect.pooled = chain[0].length() > 1 && model == TwoLevelModel::main_effects;
    effects.push_back(std::move(effect));
  }
  return effects;
}

/// Estimates of the interactions that the model leaves out, where the runs allow them; else they are not listed.
void estimate_pooled(std::vector<Effect>& effects, const Design& design, const Plan& plan, const Eigen::VectorXd& response) {
  const Model all = model_of(design, plan, effects, true);
  if (all.matrix.rows() >= all.matrix.cols() && !plan.irregular) {
    const LeastSquares fit = solve(all.matrix, response, all.names);
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (!effects[e].pooled) continue;
      effects[e].value = 2 * fit.coefficient[static_cast<Index>(e) + 1];
      effects[e].sum = {partial_sum(fit, static_cast<Index>(e) + 1), 1};
    }
    return;
  }
  std::erase_if(effects, [](const Effect& e) { return e.pooled; });
}

void fill_effects(Anova& anova, const LeastSquares& fit) {
  Index term = 1;
  for (Effect& effect : anova.effects) {
    if (effect.pooled) continue;
    effect.value = 2 * fit.coefficient[term];
    if (fit.df > 0) effect.standard_error = 2 * std::sqrt(fit.variance() * fit.inverse(term, term));
    effect.sum = {partial_sum(fit, term), 1};
    test(effect.sum, anova.residual);
    ++term;
  }
  if (term == fit.coefficient.size()) return;
  anova.curvature = SumOfSquares{partial_sum(fit, term), 1};
  test(*anova.curvature, anova.residual);
}

void add_notes(Anova& anova, const Plan& plan, const PureError& split) {
  const auto note = [&anova](std::string text) { anova.notes.push_back(std::move(text)); };
  if (plan.irregular)
    note("the runs are no regular fraction: effects share interactions in part, and their sums of squares are partial ones");
  if (!plan.relation.empty() && resolution_of(plan.relation) == "III") {
    note("resolution III: each main effect may be the interaction that it is aliased with");
  }
  if (anova.residual.df == 0)
    note("no degrees of freedom are left for the residual: no F and p; repeat runs, add centre runs or use main effects");
  if (anova.residual.df > 0 && anova.residual.value == 0)
    note("the model fits exactly: no error is left to measure, and no F or p means anything");
  if (split.copies)
    note("repeated runs agree to the last digit: no error was measured (simulations with one seed?), lack of fit is not tested");
  if (anova.curvature && anova.curvature->p < 1 - kConfidence) {
    note(fmt::format("curvature is significant (p = {:.2g}): the response is no plane between the levels; a second-order plan is due",
                     anova.curvature->p));
  }
  if (anova.lack_of_fit.p < 1 - kConfidence) {
    note(fmt::format(
        "lack of fit is significant (p = {:.2g}): interactions are more than noise; the F and p above are not to be trusted, see the model "
        "with interactions",
        anova.lack_of_fit.p));
  }
}

}  // namespace

Anova analyze_two_level(const Design& design, const Eigen::VectorXd& response, TwoLevelModel model) {
  check(design, response);
  const Plan plan = plan_of(design);
  Anova anova;
  anova.factors = design.factors;
  anova.model = model;
  anova.effects = effects_of(design, plan, model);
  const Model terms = model_of(design, plan, anova.effects, false);
  const LeastSquares fit = solve(terms.matrix, response, terms.names);
  anova.mean = fit.coefficient[0];
  anova.total = {(response.array() - response.mean()).square().sum(), static_cast<int>(response.size()) - 1};
  anova.residual = {fit.residual_sum, fit.df};
  fill_effects(anova, fit);
  estimate_pooled(anova.effects, design, plan, response);
  const PureError split = split_residual(design.coded, response, fit);
  anova.pure_error = split.pure;
  anova.lack_of_fit = split.lack_of_fit;
  anova.residuals = residuals_of(fit);
  add_notes(anova, plan, split);
  return anova;
}

std::vector<Eigen::VectorXd> steepest_descent(const Anova& anova, double coded_step_of_the_largest, int steps, double largest_p) {
  if (!std::isfinite(coded_step_of_the_largest) || coded_step_of_the_largest <= 0 || steps < 1) {
    throw UserError(fmt::format("a path of {} steps of {}; give at least one step of a positive length", steps, coded_step_of_the_largest));
  }
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(static_cast<Index>(anova.factors.size()));
  for (const Effect& effect : anova.effects) {
    if (effect.factors.size() == 1 && !(effect.sum.p > largest_p)) slope[effect.factors[0]] = effect.value;
  }
  const double largest = slope.cwiseAbs().maxCoeff();
  if (!(largest > 0))
    throw UserError(fmt::format("no factor has an effect with p at most {:.3g}: there is no direction of descent", largest_p));
  std::vector<Eigen::VectorXd> path;
  for (int step = 0; step <= steps; ++step) path.emplace_back(-slope / largest * (step * coded_step_of_the_largest));
  return path;
}

}  // namespace millscope::doe
