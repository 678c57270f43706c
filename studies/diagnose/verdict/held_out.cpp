#include "studies/diagnose/verdict/held_out.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "studies/diagnose/naming/covariance.hpp"
#include "studies/diagnose/verdict/judge.hpp"
#include "studies/diagnose/verdict/rival_models.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kFloor = 1e-6;  // of the recording's variance: what runs show without scatter (readings of the frame) is not singular

/// A way of modelling that has parameters to simulate with.
struct Way {
  std::string name, sentence;
  VectorXd coded;
  std::vector<naming::ActiveCandidate> active;
  Prediction prediction = {};
};

/// Mean of the simulations of one parameter set with several seeds. `of_one`: covariance of one of them.
Prediction simulate(const HeldOutRequest& r, const Way& way, std::size_t condition, const MatrixXd& of_one) {
  const VectorXd theta = r.problem.data.natural(way.coded);
  std::vector<campaign::Simulation> simulations;
  for (int replicate = 1; replicate <= r.seeds; ++replicate)
    simulations.push_back(simulation_at(r.question, theta, way.active, condition, replicate, way.name));
  Prediction p;
  p.name = way.name, p.sentence = way.sentence, p.theta = theta, p.simulated = true;
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
      p.value = o.value, p.power = o.power.value;
    else
      p.value += o.value, p.power += o.power.value;
  }
  if (done == 0) {
    p.failure = message;
    return p;
  }
  p.value /= done, p.covariance = of_one / done, p.power /= done;
  return p;
}

/// What every coordinate of θ does to the surrogate about a fit: [observables, θ], per unit of coded θ.
MatrixXd tangent(const naming::Surrogate& surrogate, const VectorXd& coded, const std::vector<naming::ActiveCandidate>& active) {
  MatrixXd out(surrogate.coefficients().cols(), coded.size());
  for (Index i = 0; i < coded.size(); ++i) {
    VectorXd up = coded, down = coded;
    up[i] += 0.5, down[i] -= 0.5;
    out.col(i) = surrogate.at(up, active) - surrogate.at(down, active);
  }
  return out;
}

/// Inverse of the covariance that θ has after a fit, in coded units: its priors' with what observables, of which the tangent is in noise
/// units, tell of it.
MatrixXd information(const naming::BankData& data, const MatrixXd& white_tangent) {
  MatrixXd out = white_tangent.transpose() * white_tangent;
  for (Index i = 0; i < out.rows(); ++i) out(i, i) += std::pow(data.theta[i].prior_weight(), 2);
  return out;
}

/// Covariance of what the base predicts in a held-out condition [observables, observables], by what the fit leaves open of θ. A parameter
/// that it tells nothing of lies anywhere in its range. Readings of the camera's frame have an error that all recordings share
/// (frame_readings.hpp): of these a little too much is counted.
MatrixXd error_of_fit(const HeldOutRequest& r, const naming::Surrogate& fitted, const naming::Surrogate& held) {
  const VectorXd& coded = r.naming.base.coded;
  MatrixXd precision = information(r.problem.data, naming::whitener(r.naming.covariance) * tangent(fitted, coded, {}));
  for (Index i = 0; i < coded.size(); ++i) {  // about the fitted value the mean square of what lies anywhere between −1 and 1
    if (!r.problem.data.theta[i].nuisance()) precision(i, i) += 1 / (1.0 / 3 + coded[i] * coded[i]);
  }
  const MatrixXd there = tangent(held, coded, {});
  return there * precision.ldlt().solve(there.transpose());
}

/// What the best alternative has on; nothing where there is none, or a nuisance is the best.
std::vector<naming::ActiveCandidate> best_active(const HeldOutRequest& r) {
  if (!r.naming.best) return {};
  return naming::active_of(r.problem.alternatives[*r.naming.best], r.naming.judged[*r.naming.best].fit);
}

/// The bank's runs in the held-out condition that tell what the surrogate gets wrong there.
std::vector<MatrixXd> left_out(const naming::BankData& data, const std::vector<naming::ActiveCandidate>& active) {
  std::vector<MatrixXd> out{naming::left_out_deviations(data, {})};
  for (const naming::ActiveCandidate& e : active) out.push_back(naming::left_out_deviations(data, e.candidate));
  return out;
}

class HeldOutTrial {
 public:
  HeldOutTrial(const HeldOutRequest& request, std::size_t condition)
      : r_(request),
        condition_(condition),
        held_(problem_alone(request.question, request.evidence, request.bank, condition, request.problem.data)),
        surrogate_(held_.data),
        left_out_(left_out(held_.data, best_active(request))) {
    const naming::Surrogate fitted(r_.problem.data);
    error_of_fit_ = error_of_fit(r_, fitted, surrogate_);
    const RivalModels rivals(r_, condition, fitted, surrogate_, held_.covariance.diagonal());
    add_ways(rivals);
    if (r_.naming.best) placebo_ = rivals.placebo(), discrepancy_ = rivals.discrepancy();
    for (Way& way : ways_) way.prediction = predicted(way);
  }

  HeldOut run() {
    for (;;) {
      HeldOut out = judged();
      const std::set<std::size_t> wanted = to_simulate(out);
      if (wanted.empty()) return out;
      for (const std::size_t k : wanted) ways_[k].prediction = simulate(r_, ways_[k], condition_, of_one_run(ways_[k]));
    }
  }

 private:
  /// The refitted base is the last.
  void add_ways(const RivalModels& rivals) {
    if (r_.naming.best) {
      const VectorXd& coded = r_.naming.judged[*r_.naming.best].fit.coded;
      const std::vector<naming::ActiveCandidate> active = best_active(r_);
      ways_.push_back({"corrected", "with the best candidate, all parameters fitted together", coded, active});
      if (!active.empty()) ways_.push_back({"effect removed", "the corrected parameters without the effect", coded, {}});
    }
    if (const auto metered = rivals.metered()) {
      ways_.push_back({kToPower,
                       fmt::format("the base, friction retuned until the power at '{}' matches: the practice",
                                   r_.question.study.conditions[*metered].name),
                       rivals.power_only(*metered),
                       {}});
    }
    ways_.push_back({"retuned to all observables", "the base, parameters refitted to all observables", r_.naming.base.coded, {}});
  }

  double power_in(const VectorXd& value) const {
    const auto i = r_.evidence.recorded[condition_].find(calibrate::ObservableKind::power);
    return i ? value[*i] : std::nan("");
  }

  Prediction predicted(const Way& way) const {
    Prediction p;
    p.name = way.name, p.sentence = way.sentence, p.theta = held_.data.natural(way.coded);
    p.value = surrogate_.at(way.coded, way.active);
    p.covariance = surrogate_.error_covariance(held_.covariance, way.coded, way.active);
    p.covariance.diagonal() += kFloor * held_.covariance.diagonal();
    p.power = power_in(p.value);
    return p;
  }

  /// Covariance of one simulation: what the bank's runs there scatter by about the surrogate.
  MatrixXd of_one_run(const Way& way) const {
    MatrixXd out = surrogate_.scatter_of(way.active) * surrogate_.residual_covariance(held_.covariance);
    out.diagonal() += kFloor * held_.covariance.diagonal();
    return out;
  }

  /// As if the surrogate did not err. A prediction's own error would hide what differs: with it an alarm is too easily missed.
  Prediction exact(const Prediction& p) const {
    Prediction out = p;
    if (!p.simulated) out.covariance = MatrixXd(VectorXd(kFloor * held_.covariance.diagonal()).asDiagonal());
    return out;
  }

  /// The base with what the fitted recordings leave open of θ: others would have moved it.
  Prediction with_error_of_fit(Prediction base) const {
    base.covariance += error_of_fit_;
    return base;
  }

  Prediction moved(const std::string& name, const std::string& sentence, const VectorXd& by) const {
    Prediction p = ways_.back().prediction;
    p.name = name, p.sentence = sentence, p.computed = true;
    p.value += by;
    if (std::isfinite(power_in(p.value))) p.power = power_in(p.value);
    return p;
  }

  /// Whether there is a corrected model to compare with, the first of the ways and of the scores.
  bool compared() const { return r_.naming.best && ways_.front().prediction.failure.empty(); }

  std::vector<Prediction> predictions() const {
    std::vector<Prediction> all;
    for (const Way& way : ways_) all.push_back(way.prediction);
    if (compared() && ways_.back().prediction.failure.empty()) {
      all.push_back(moved("placebo", "the base with a free parameter of no meaning, the best of twenty such", placebo_));
      all.push_back(moved("Gaussian-process discrepancy",
                          "the base with the residuals of the fitted conditions carried over by a Gaussian process", discrepancy_));
    }
    return all;
  }

  HeldOut judged() const {
    std::vector<Prediction> all = predictions();
    Judge judge = Judge::of(held_, left_out_, all);
    judge.power = r_.evidence.recorded[condition_].power.value;
    HeldOut out;
    out.condition = condition_, out.variance = held_.covariance.diagonal();
    for (const Way& way : ways_) out.simulations += way.prediction.simulated ? r_.seeds : 0;
    const auto& observables = r_.evidence.recorded[condition_].observables;
    for (std::size_t i = 0; i < observables.size(); ++i) {
      if (!std::binary_search(judge.kept.begin(), judge.kept.end(), Index(i))) out.not_compared.push_back(observables[i].name);
    }
    const Prediction& base = ways_.back().prediction;
    if (base.failure.empty())
      out.base_p = judge.goodness(with_error_of_fit(base), r_.seed),
      out.strict_base_p = judge.goodness(with_error_of_fit(exact(base)), r_.seed);
    for (Prediction& p : all) {
      if (!p.failure.empty())
        out.failures.push_back(fmt::format("{}: {}", p.name, p.failure));
      else
        out.scores.push_back(judge.score(std::move(p)));
    }
    if (compared()) compare(judge, out);
    return out;
  }

  void compare(const Judge& judge, HeldOut& out) const {
    out.improves = out.failures.empty();
    for (std::size_t k = 1; k < out.scores.size(); ++k) {
      judge.compare(out.scores[0], out.scores[k], r_.seed + k);
      out.improves = out.improves && out.scores[k].improvement.low > 0;
      out.contradicts = out.contradicts || out.scores[k].improvement.high < 0;
    }
  }

  std::size_t way_of(const Prediction& p) const {
    if (p.computed) return ways_.size() - 1;
    return std::find_if(ways_.begin(), ways_.end(), [&](const Way& w) { return w.name == p.name; }) - ways_.begin();
  }

  /// The ways that have to be simulated next; none: what is known suffices.
  std::set<std::size_t> to_simulate(const HeldOut& out) const {
    std::set<std::size_t> wanted;
    if (r_.naming.best && !compared()) return wanted;  // the corrected case fails: no name is possible
    const auto ask = [&](std::size_t way) {
      if (!ways_[way].prediction.simulated) wanted.insert(way);
    };
    for (std::size_t k = compared() ? 0 : ways_.size() - 1; k < ways_.size(); ++k) {  // at an end the surrogate errs most
      if (!naming::ends_of(r_.problem, ways_[k].coded, ways_[k].active).empty()) ask(k);
    }
    for (std::size_t k = compared() ? 1 : 0; k < out.scores.size(); ++k) {
      if (out.scores[k].reliance.enough()) continue;
      ask(way_of(out.scores[k].prediction));
      if (compared()) ask(0);
    }
    if (!r_.naming.best && out.strict_base_p <= r_.alarm) ask(ways_.size() - 1);
    if (!r_.at_stake || !compared()) return wanted;
    for (const std::vector<std::size_t>& next : at_stake(out)) {
      if (!wanted.empty()) break;  // simulations make the errors smaller by which the next are chosen
      for (const std::size_t way : next) ask(way);
    }
    return wanted;
  }

  /// What a name rests on, in the order in which it is asked for: corrected case, practice and strongest rival; rivals that may be the
  /// strongest; what the surrogate's error alone leaves open.
  std::vector<std::vector<std::size_t>> at_stake(const HeldOut& out) const {
    std::vector<std::size_t> rivals;
    std::vector<base::Interval90> improvements;
    std::vector<std::vector<std::size_t>> order{{0}, {}, {}};
    for (std::size_t k = 1; k < out.scores.size(); ++k) {
      rivals.push_back(way_of(out.scores[k].prediction));
      improvements.push_back(out.scores[k].improvement);
      if (out.scores[k].prediction.name == kToPower) order[0].push_back(rivals.back());
      if (!(improvements.back().low > 0)) order[2].push_back(rivals.back());
    }
    if (!rivals.empty()) order[0].push_back(rivals[strongest(improvements)]);
    for (const std::size_t k : near_strongest(improvements)) order[1].push_back(rivals[k]);
    return order;
  }

  const HeldOutRequest& r_;
  std::size_t condition_;
  naming::Problem held_;
  naming::Surrogate surrogate_;
  std::vector<MatrixXd> left_out_;
  MatrixXd error_of_fit_;  ///< of the refitted base
  std::vector<Way> ways_;
  VectorXd placebo_, discrepancy_;  ///< what these rivals add to the refitted base
};

}  // namespace

HeldOut hold_against(const HeldOutRequest& r, std::size_t condition) { return HeldOutTrial(r, condition).run(); }

bool HeldOut::rests_on_simulations() const {
  if (scores.empty() || !scores[0].prediction.simulated) return false;
  std::vector<base::Interval90> improvements;
  for (std::size_t k = 1; k < scores.size(); ++k) {
    if (scores[k].prediction.name == kToPower && !scores[k].prediction.simulated) return false;
    improvements.push_back(scores[k].improvement);
  }
  const std::vector<std::size_t> near = near_strongest(improvements);
  return std::all_of(near.begin(), near.end(), [this](std::size_t k) { return scores[k + 1].prediction.simulated; });
}

std::string sources_sentence(const HeldOut& held) {
  std::vector<std::string> simulated, predicted;
  for (const Score& s : held.scores) {
    if (!s.prediction.computed) (s.prediction.simulated ? simulated : predicted).push_back(s.prediction.name);
  }
  std::string out;
  if (!simulated.empty()) out = fmt::format("{} simulated ({} simulations)", fmt::join(simulated, ", "), held.simulations);
  if (!predicted.empty()) out += fmt::format("{}{} predicted by the bank's surrogate", out.empty() ? "" : "; ", fmt::join(predicted, ", "));
  if (!held.failures.empty()) out += fmt::format("{}{} failed", out.empty() ? "" : "; ", fmt::join(held.failures, ", "));
  return out.empty() ? "nothing came to its end" : out;
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
      const MatrixXd precision = information(one.data, w * tangent(surrogate, found.coded, on));
      const VectorXd sd = precision.ldlt().solve(MatrixXd::Identity(d, d)).diagonal().cwiseMax(0).cwiseSqrt();
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
