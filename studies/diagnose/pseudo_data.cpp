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
  const double mean_leverage = static_cast<double>(features_->base_size()) / static_cast<double>(data.rows.size());
  covariance_ = problem.covariance + (1 + mean_leverage) * surrogate_->residual_covariance();
  whitener_ = whitener(covariance_);
  recording_factor_ = Eigen::LLT<MatrixXd>(problem.covariance).matrixL();
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    if (!data.rows[r].effects.empty()) continue;
    LeftOut left;
    std::vector<bool> used = all;
    used[r] = false;
    left.surrogate = std::make_unique<Surrogate>(data, *features_, used);
    const VectorXd u = data.coded(data.rows[r].theta);
    left.deviation = data.value.row(static_cast<Index>(r)).transpose() - left.surrogate->at(u);
    left.leverage = left.surrogate->leverage(u);
    left_out_.push_back(std::move(left));
  }
  if (left_out_.size() < kLeastBase)
    throw config::UserError(
        fmt::format("the bank has {} finished runs without an effect, the null needs {}; raise bank.base", left_out_.size(), kLeastBase));
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

Truth PseudoData::truth(const Choice& choice, const FitResult& fit) const { return {fit.coded, model(*surrogate_, choice).effects(fit)}; }

VectorXd PseudoData::pseudo_recording(const LeftOut& left, const Truth& truth, emulate::Random& random) const {
  VectorXd u = truth.coded;
  for (Index i = 0; i < u.size(); ++i) {
    const Coordinate& c = problem_.data.theta[static_cast<std::size_t>(i)];
    if (c.nuisance()) u[i] = std::clamp(c.coded(c.prior_mean + c.prior_sigma * random.normal()), -1.0, 1.0);
  }
  const double scale = std::sqrt((1 + left.surrogate->leverage(u, truth.effects)) / (1 + left.leverage));
  return left.surrogate->at(u, truth.effects) + scale * left.deviation + recording_factor_ * random.normals(left.deviation.size());
}

std::vector<PseudoData::Drawn> PseudoData::draw(const Truth& truth, const std::vector<Choice>& choices, int draws,
                                                std::uint64_t stream) const {
  std::vector<std::vector<Model>> models;  // [left out][choices]
  for (const LeftOut& left : left_out_) {
    models.emplace_back();
    for (const Choice& choice : choices) models.back().push_back(model(*left.surrogate, choice));
  }
  std::vector<Drawn> out(static_cast<std::size_t>(draws));
  studies::for_each_item(out.size(), studies::worker_count(options_.threads, out.size()), [&](std::size_t b, std::size_t) {
    emulate::Random random(options_.seed + stream, b);
    const std::size_t r = b % left_out_.size();
    const VectorXd y = pseudo_recording(left_out_[r], truth, random);
    for (const Model& m : models[r]) out[b].fit.push_back(m.fit(y));
    const FitResult& first = out[b].fit.front();
    out[b].residual = y - left_out_[r].surrogate->at(first.coded, models[r].front().effects(first));
  });
  return out;
}

}  // namespace millscope::diagnose
