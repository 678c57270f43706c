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
constexpr std::size_t kEnoughWith = 12;  // runs with an effect, for intervals from them alone
constexpr double kFaint = 0.1;           // of a share: the bank has no runs with less

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
    left.effects = effects;
    left.candidate = effects.empty() ? -1 : effects.front().candidate;
    base += effects.empty() && data.usual(data.rows[r]) ? 1 : 0;
    left_out_.push_back(std::move(left));
  }
  weigh_effects();
  if (base < kLeastBase)
    throw config::UserError(
        fmt::format("the bank has {} finished runs without an effect, the null needs {}; raise bank.base", base, kLeastBase));
}

/// With an effect the surrogate may err by more than without: mean whitened square of the left-out deviations over that without one, at
/// least 1.
void PseudoData::weigh_effects() {
  std::vector<double> sum(ranges_.size() + 1, 0.0), runs(sum.size(), 0.0);  // the first: without
  for (const LeftOut& left : left_out_) {
    const auto k = static_cast<std::size_t>(left.candidate + 1);
    sum[k] += (whitener_ * left.deviation).squaredNorm() / (1 + left.leverage), runs[k] += 1;
  }
  error_with_.assign(ranges_.size(), 1.0);
  for (std::size_t j = 0; j < ranges_.size(); ++j) {
    if (runs[j + 1] > 0 && sum[0] > 0) error_with_[j] = std::max(1.0, sum[j + 1] / runs[j + 1] * runs[0] / sum[0]);
  }
}

double PseudoData::error_of(const std::vector<Effect>& effects) const {
  double out = 1;
  for (const Effect& e : effects) out += std::fabs(e.share) < kFaint ? 0 : error_with_[static_cast<std::size_t>(e.candidate)] - 1;
  return out;
}

std::vector<const PseudoData::LeftOut*> PseudoData::runs_for(const Truth& truth, bool for_intervals) const {
  std::vector<const LeftOut*> out, with;
  for (const LeftOut& left : left_out_) {
    const auto has = [&](const Effect& e) { return e.candidate == left.candidate && std::fabs(e.share) >= kFaint; };
    const bool shares = std::any_of(truth.effects.begin(), truth.effects.end(), has);
    if (shares) with.push_back(&left);
    if (shares || left.candidate < 0) out.push_back(&left);
  }
  return for_intervals && with.size() >= kEnoughWith ? with : out;
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

VectorXd Truth::coordinates() const {
  std::vector<double> shares;
  for (const Effect& e : effects) shares.push_back(e.share);
  return coordinates_of(coded, shares);
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
  const double wanted = (1 - chance + left.surrogate->leverage(u, truth.effects)) * error_of(truth.effects);
  const double scale = std::sqrt(wanted / ((1 + left.leverage) * error_of(left.effects)));
  return left.surrogate->at(u, truth.effects) + scale * left.deviation + noise * random.normals(left.deviation.size());
}

VectorXd PseudoData::rise(const Model& model, const Truth& truth, double least, const VectorXd& y) {
  const VectorXd t = truth.coordinates();
  VectorXd out(t.size());
  for (Index i = 0; i < t.size(); ++i) out[i] = model.fit_holding(i, t[i], y).q - least;
  return out;
}

std::vector<PseudoData::Drawn> PseudoData::draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const {
  const std::vector<const LeftOut*> runs = runs_for(truth, how.for_intervals);
  std::vector<std::vector<Model>> models;  // [left out][choices]
  for (const LeftOut* left : runs) {
    models.emplace_back();
    for (const Choice& choice : choices) models.back().push_back(model(*left->surrogate, choice));
  }
  std::vector<Drawn> out(static_cast<std::size_t>(how.count));
  studies::for_each_item(out.size(), studies::worker_count(options_.threads, out.size()), [&](std::size_t b, std::size_t) {
    emulate::Random random(options_.seed + how.stream, b);
    const std::size_t r = b / laws() % runs.size();
    const Truth drawn{drawn_theta(truth, random), truth.effects, truth.freed};
    const VectorXd y = pseudo_recording(*runs[r], drawn, how.for_intervals ? 0 : chance_, noise_factors_[b % laws()], random);
    for (const Model& m : models[r]) out[b].fit.push_back(m.fit(y));
    const FitResult& first = out[b].fit.front();
    out[b].residual = y - runs[r]->surrogate->at(first.coded, models[r].front().effects(first));
    if (how.for_intervals) out[b].rise = rise(models[r].front(), drawn, first.q, y);
  });
  return out;
}

}  // namespace millscope::diagnose
