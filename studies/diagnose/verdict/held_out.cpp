#include "studies/diagnose/verdict/held_out.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/random.hpp"
#include "studies/diagnose/verdict/rival_models.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kDraws = 4000;

/// Mean of the simulations of one parameter set with several seeds.
Prediction simulate(const HeldOutRequest& r, const VectorXd& coded, const std::vector<naming::ActiveCandidate>& active,
                    std::size_t condition, const std::string& name) {
  const VectorXd theta = r.problem.data.natural(coded);
  std::vector<campaign::Simulation> simulations;
  for (int replicate = 1; replicate <= r.seeds; ++replicate)
    simulations.push_back(simulation_at(r.question, theta, active, condition, replicate, name));
  Prediction p;
  p.name = name;
  int done = 0;
  std::string message;
  for (const campaign::Outcome& outcome : r.machinery.run(simulations)) {
    calibrate::Observation o;
    try {
      o = r.evidence.look(r.machinery, r.question, condition, outcome, theta);
    } catch (const base::UserError& e) {
      message = e.what();
      continue;
    }
    if (done++ == 0)
      p.value = o.value, p.covariance = o.covariance, p.power = o.power.value;
    else
      p.value += o.value, p.covariance += o.covariance, p.power += o.power.value;
  }
  if (done == 0) {
    p.failure = message;
    return p;
  }
  p.value /= done, p.covariance /= done * done, p.power /= done;
  return p;
}

struct Judge {
  std::vector<Index> kept;  ///< observables that every prediction defines; of these are the others
  VectorXd observed;
  MatrixXd recording;           ///< covariance: the weight
  std::vector<MatrixXd> noise;  ///< factors of the laws of the recording's noise
  double power = 0;

  static double misfit(const VectorXd& r, const Eigen::LLT<MatrixXd>& c) { return r.dot(c.solve(r)) / static_cast<double>(r.size()); }

  Prediction part(const Prediction& p) const {
    Prediction out = p;
    out.value = VectorXd(p.value(kept)), out.covariance = MatrixXd(p.covariance(kept, kept));
    return out;
  }

  /// Improvement of the first prediction over another, with what noise of recording and simulations leaves open; the widest interval over
  /// the laws of noise.
  void compare(const Score& corrected, Score& rival, std::uint64_t seed) const {
    const Prediction one = part(corrected.prediction), other = part(rival.prediction);
    const Eigen::LLT<MatrixXd> c(recording + 0.5 * (one.covariance + other.covariance));
    base::Interval90& found = rival.improvement;
    found.value = misfit(observed - other.value, c) - misfit(observed - one.value, c);
    const MatrixXd first = naming::factor(one.covariance), second = naming::factor(other.covariance);
    found.low = std::numeric_limits<double>::infinity(), found.high = -found.low;
    base::RandomStream random(seed, 9);
    for (const MatrixXd& law : noise) {
      std::vector<double> draws;
      for (int b = 0; b < kDraws; ++b) {
        const VectorXd y = observed + law * random.normals(observed.size());
        draws.push_back(misfit(y - other.value - second * random.normals(y.size()), c) -
                        misfit(y - one.value - first * random.normals(y.size()), c));
      }
      std::sort(draws.begin(), draws.end());
      found.low = std::min(found.low, draws[kDraws / 20]), found.high = std::max(found.high, draws[kDraws - 1 - kDraws / 20]);
    }
  }

  /// How often a recording of this very prediction would look as bad; the largest over the laws of noise.
  double goodness(const Prediction& whole, std::uint64_t seed) const {
    const Prediction p = part(whole);
    const Eigen::LLT<MatrixXd> c(recording + p.covariance);
    const double seen = misfit(observed - p.value, c);
    const MatrixXd own = naming::factor(p.covariance);
    base::RandomStream random(seed, 10);
    double largest = 0;
    for (const MatrixXd& law : noise) {
      int above = 0;
      for (int b = 0; b < kDraws; ++b)
        above += misfit(law * random.normals(observed.size()) + own * random.normals(observed.size()), c) >= seen ? 1 : 0;
      largest = std::max(largest, (1.0 + above) / (1.0 + kDraws));
    }
    return largest;
  }
};

Score score(const Judge& judge, Prediction prediction) {
  Score s;
  const Prediction part = judge.part(prediction);
  s.misfit = Judge::misfit(judge.observed - part.value, Eigen::LLT<MatrixXd>(MatrixXd(judge.recording + part.covariance)));
  s.power_percent = 100 * (prediction.power - judge.power) / judge.power;
  s.prediction = std::move(prediction);
  return s;
}

Judge judge_of(const HeldOutRequest& r, std::size_t condition, const std::vector<Prediction>& predictions) {
  naming::Problem held;
  add_recorded(r.question, r.evidence, r.bank, {condition}, held);
  Judge judge{{}, {}, {}, {}, r.evidence.recorded[condition].power.value};
  for (Index i = 0; i < held.observed.size(); ++i) {
    if (std::all_of(predictions.begin(), predictions.end(),
                    [i](const Prediction& p) { return !p.failure.empty() || std::isfinite(p.value[i]); }))
      judge.kept.push_back(i);
  }
  judge.observed = held.observed(judge.kept), judge.recording = held.covariance(judge.kept, judge.kept);
  for (const MatrixXd& law : held.noise) judge.noise.push_back(naming::factor(MatrixXd(law(judge.kept, judge.kept))));
  return judge;
}

HeldOut judged(const HeldOutRequest& r, std::size_t condition, std::vector<Prediction> all, const Prediction& base, bool compared) {
  const Judge judge = judge_of(r, condition, all);
  HeldOut out;
  out.condition = condition;
  const auto& observables = r.evidence.recorded[condition].observables;
  for (std::size_t i = 0; i < observables.size(); ++i) {
    if (!std::binary_search(judge.kept.begin(), judge.kept.end(), Index(i))) out.not_compared.push_back(observables[i].name);
  }
  if (base.failure.empty()) out.base_p = judge.goodness(base, r.seed);
  for (Prediction& p : all) {
    if (!p.failure.empty())
      out.failures.push_back(fmt::format("{}: {}", p.name, p.failure));
    else
      out.scores.push_back(score(judge, std::move(p)));
  }
  if (!compared) return out;
  out.improves = out.failures.empty();
  for (std::size_t k = 1; k < out.scores.size(); ++k) {
    judge.compare(out.scores[0], out.scores[k], r.seed + k);
    out.improves = out.improves && out.scores[k].improvement.low > 0;
    out.contradicts = out.contradicts || out.scores[k].improvement.high < 0;
  }
  return out;
}

/// What the best alternative has on; nothing where there is none, or a nuisance is the best.
std::vector<naming::ActiveCandidate> best_active(const HeldOutRequest& r) {
  if (!r.naming.best) return {};
  return naming::active_of(r.problem.alternatives[*r.naming.best], r.naming.judged[*r.naming.best].fit);
}

}  // namespace

HeldOut hold_against(const HeldOutRequest& r, std::size_t condition) {
  const RivalModels rivals(r, condition);
  std::vector<Prediction> all;
  const auto add = [&](Prediction p, const std::string& sentence) {
    p.sentence = sentence;
    all.push_back(std::move(p));
  };
  if (r.naming.best) {
    const naming::Judged& best = r.naming.judged[*r.naming.best];
    const std::vector<naming::ActiveCandidate> active = best_active(r);
    add(simulate(r, best.fit.coded, active, condition, "corrected"), "with the best candidate, all parameters fitted together");
    if (!active.empty()) add(simulate(r, best.fit.coded, {}, condition, "effect removed"), "the corrected parameters without the effect");
  }
  const bool compared = !all.empty() && all.front().failure.empty();  // the corrected model, first of the scores
  const Prediction base = simulate(r, r.naming.base.coded, {}, condition, "retuned to all observables");
  if (const auto metered = rivals.metered()) {
    add(simulate(r, rivals.power_only(*metered), {}, condition, "retuned to power"),
        fmt::format("the base, friction retuned until the power at '{}' matches: the practice",
                    r.question.study.conditions[*metered].name));
  }
  add(base, "the base, parameters refitted to all observables");
  if (compared && base.failure.empty()) {
    add(rivals.placebo(base), "the base with a free parameter of no meaning, the best of twenty such");
    add(rivals.discrepancy(base), "the base with the residuals of the fitted conditions carried over by a Gaussian process");
  }
  return judged(r, condition, std::move(all), base, compared);
}

std::vector<Alone> fit_alone(const HeldOutRequest& r) {
  std::vector<Alone> out;
  const std::vector<naming::ActiveCandidate> active = best_active(r);
  for (const std::size_t condition : r.bank.conditions) {
    const naming::Problem one = problem_alone(r.question, r.evidence, r.bank, condition, r.problem.data);
    const naming::Surrogate surrogate(one.data);
    const naming::Weighting weighting(one.covariance, surrogate);
    const MatrixXd& w = weighting.whitener;
    const auto fit = [&](const std::vector<naming::ActiveCandidate>& on) {
      naming::Switched switched{{}, std::vector<naming::StrengthRange>(one.data.candidates), {}};
      for (const naming::ActiveCandidate& e : on)
        switched.on.push_back(e.candidate), switched.ranges[e.candidate] = {e.strength, e.strength};
      const naming::FitResult found = naming::Model(one.data, surrogate, weighting, switched).fit(one.observed);
      const Index d = found.coded.size();
      MatrixXd information = MatrixXd::Zero(d, d), tangent(w.rows(), d);
      for (Index i = 0; i < d; ++i) {
        VectorXd up = found.coded, down = found.coded;
        up[i] += 0.5, down[i] -= 0.5;
        tangent.col(i) = w * (surrogate.at(up, on) - surrogate.at(down, on));
        const naming::Coordinate& c = one.data.theta[i];
        information(i, i) = std::pow(c.prior_weight(), 2);
      }
      information += tangent.transpose() * tangent;
      const VectorXd sd = information.ldlt().solve(MatrixXd::Identity(d, d)).diagonal().cwiseMax(0).cwiseSqrt();
      std::vector<base::Interval90> theta;
      for (Index i = 0; i < d; ++i) {
        const naming::Coordinate& c = one.data.theta[i];
        const auto at = [&](double u) { return c.natural(std::clamp(u, -1.0, 1.0)); };
        theta.push_back({at(found.coded[i]), at(found.coded[i] - base::kNormal90 * sd[i]), at(found.coded[i] + base::kNormal90 * sd[i])});
      }
      return theta;
    };
    Alone alone{condition, fit({}), {}};
    if (!active.empty()) alone.after = fit(active);
    out.push_back(std::move(alone));
  }
  return out;
}

}  // namespace millscope::diagnose
