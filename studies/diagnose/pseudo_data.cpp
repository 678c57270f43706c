#include "studies/diagnose/pseudo_data.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernel/config/error.hpp"
#include "studies/analysis/parallel.hpp"

namespace millscope::diagnose {
namespace {

constexpr std::size_t kLeastBase = 8;
constexpr std::size_t kEnoughWith = 12;  // runs with an effect, so that a draw does not hang on a few of them

std::vector<ShareRange> ranges_of(const Problem& problem) {
  std::vector<ShareRange> ranges(static_cast<std::size_t>(problem.data.candidates));
  for (const Rival& r : problem.rivals) {
    if (r.candidate >= 0) ranges[static_cast<std::size_t>(r.candidate)] = r.range;
  }
  return ranges;
}

}  // namespace

PseudoData::PseudoData(const Problem& problem, const NamingOptions& options)
    : problem_(problem), options_(options), features_(std::make_unique<Features>(problem.data)), ranges_(ranges_of(problem)) {
  const BankData& data = problem.data;
  const std::vector<bool> all(data.rows.size(), true);
  surrogate_ = std::make_unique<Surrogate>(data, *features_, all);
  chance_ = surrogate_->chance(problem.covariance);
  covariance_ = problem.covariance + surrogate_->error_covariance(problem.covariance);
  whitener_ = whitener(covariance_);
  for (const MatrixXd& law : problem.noise) noise_factors_.push_back(factor(law));
  if (noise_factors_.empty()) noise_factors_.push_back(factor(problem.covariance));
  std::size_t base = 0;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    LeftOut left;
    std::vector<bool> used = all;
    for (std::size_t other = 0; other < used.size(); ++other) used[other] = !repeats(data.rows[other], data.rows[r]);
    left.surrogate = std::make_unique<Surrogate>(data, *features_, used);
    const VectorXd u = data.coded(data.rows[r].theta);
    const std::vector<Effect>& effects = data.rows[r].effects;
    left.deviation = data.value.row(static_cast<Index>(r)).transpose() - left.surrogate->at(u, effects);
    left.leverage = left.surrogate->leverage(u, effects);
    left.candidate = effects.empty() ? -1 : effects.front().candidate;
    base += effects.empty() && data.usual(data.rows[r]) ? 1 : 0;
    left_out_.push_back(std::move(left));
  }
  if (base < kLeastBase)
    throw config::UserError(
        fmt::format("the bank has {} finished runs without an effect, the null needs {}; raise bank.base", base, kLeastBase));
}

/// Runs whose deviations stand for the surrogate's error under a truth: those with the effects that it has, about which it may err by more
/// than without any; where they are few, and where it has none, those without an effect as well.
std::vector<const PseudoData::LeftOut*> PseudoData::fitting(const Truth& truth) const {
  std::vector<const LeftOut*> with, without;
  for (const LeftOut& left : left_out_) {
    const bool has =
        std::any_of(truth.effects.begin(), truth.effects.end(), [&](const Effect& e) { return e.candidate == left.candidate; });
    if (has) with.push_back(&left);
    if (left.candidate < 0) without.push_back(&left);
  }
  if (with.size() < kEnoughWith) with.insert(with.begin(), without.begin(), without.end());
  return with;
}

Model PseudoData::model(const Surrogate& surrogate, const Choice& choice) const {
  std::vector<int> active;
  Index freed = -1;
  for (const int r : choice) {
    const Rival& rival = problem_.rivals[static_cast<std::size_t>(r)];
    if (rival.candidate >= 0) active.push_back(rival.candidate);
    if (rival.freed >= 0) freed = rival.freed;
  }
  return {problem_.data, surrogate, whitener_, active, ranges_, freed};
}

FitResult PseudoData::fit(const Choice& choice) const { return model(*surrogate_, choice).fit(problem_.observed); }

Truth PseudoData::truth(const Choice& choice, const FitResult& fit) const {
  Truth truth{fit.coded, model(*surrogate_, choice).effects(fit), -1};
  for (const int r : choice) truth.freed = std::max(truth.freed, problem_.rivals[static_cast<std::size_t>(r)].freed);
  return truth;
}

VectorXd PseudoData::drawn_theta(const Truth& truth, emulate::Random& random) const {
  VectorXd u = truth.coded;
  for (Index i = 0; i < u.size(); ++i) {
    const Coordinate& c = problem_.data.theta[static_cast<std::size_t>(i)];
    if (!c.nuisance() || i == truth.freed) continue;
    const double centre = c.coded(c.prior_mean), sigma = 1 / c.prior_weight();
    do u[i] = centre + sigma * random.normal();
    while (std::fabs(u[i]) > 1);  // the prior's mean lies within the range
  }
  return u;
}

VectorXd PseudoData::pseudo_recording(const LeftOut& left, const Truth& truth, double chance, const MatrixXd& noise,
                                      emulate::Random& random) const {
  const VectorXd& u = truth.coded;
  const double scale = std::sqrt((1 - chance + left.surrogate->leverage(u, truth.effects)) / (1 + left.leverage));
  return left.surrogate->at(u, truth.effects) + scale * left.deviation + noise * random.normals(left.deviation.size());
}

std::vector<PseudoData::Drawn> PseudoData::draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const {
  const double chance = how.deviation == Deviation::whole ? 0 : chance_;
  const std::vector<const LeftOut*> runs = fitting(truth);
  std::vector<std::vector<Model>> models;  // [left out][choices]
  for (const LeftOut* left : runs) {
    models.emplace_back();
    for (const Choice& choice : choices) models.back().push_back(model(*left->surrogate, choice));
  }
  std::vector<Drawn> out(static_cast<std::size_t>(how.count));
  studies::for_each_item(out.size(), studies::worker_count(options_.threads, out.size()), [&](std::size_t b, std::size_t) {
    emulate::Random random(options_.seed + how.stream, b);
    const std::size_t r = b / laws() % runs.size();
    out[b].truth = drawn_theta(truth, random);
    const VectorXd y = pseudo_recording(*runs[r], {out[b].truth, truth.effects, truth.freed}, chance, noise_factors_[b % laws()], random);
    for (const Model& m : models[r]) out[b].fit.push_back(m.fit(y));
    const FitResult& first = out[b].fit.front();
    if (how.rises) {
      std::vector<double> shares;
      for (const Effect& e : truth.effects) shares.push_back(e.share);
      const VectorXd t = coordinates_of(out[b].truth, shares);
      out[b].rise.resize(t.size());
      for (Index i = 0; i < t.size(); ++i) out[b].rise[i] = models[r].front().fit_holding(i, t[i], y).q - first.q;
    }
    out[b].residual = y - runs[r]->surrogate->at(first.coded, models[r].front().effects(first));
  });
  return out;
}

}  // namespace millscope::diagnose
