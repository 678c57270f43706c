#include "studies/diagnose/naming/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::naming {
namespace {

constexpr int kSteps = 8;  // of the curve, on each side of zero

/// The priors about θ, as noise-free data of it have them; a freed nuisance keeps its own.
BankData about(BankData data, const VectorXd& coded, std::optional<Index> freed) {
  for (Index i = 0; i < coded.size(); ++i) {
    Coordinate& c = data.theta[i];
    if (!c.nuisance() || i == freed) continue;
    const double before = c.prior_mean;
    c.prior_mean = c.natural(coded[i]);
    if (c.logarithmic) c.prior_sigma *= c.prior_mean / before;  // the weight is that of the logarithm
  }
  return data;
}

/// What is refitted: θ, and what is on besides.
Switched refitted(const Problem& problem, const std::vector<ActiveCandidate>& beside) {
  Switched out{{}, ranges_of(problem), {}, true};
  for (const ActiveCandidate& a : beside) out.on.push_back(a.candidate);
  return out;
}

}  // namespace

Visibility::Visibility(const Problem& problem, const Surrogate& surrogate, const Weighting& weighting, const About& at, Index alternative)
    : problem_(problem),
      surrogate_(surrogate),
      weighting_(weighting),
      coded_(at.coded),
      beside_(at.beside),
      alternative_(problem.alternatives[alternative]),
      base_(about(problem.data, coded_, alternative_.freed), surrogate, weighting, refitted(problem, beside_)) {
  const auto n = static_cast<double>(weighting.whitener.rows());
  run_covariance_ = weighting.whitener * weighting.run * weighting.whitener.transpose();
  run_noise_ = weighting.run_noise * (n - static_cast<double>(coded_.size())) / n;
  for (const double strength : strengths()) curve_.emplace_back(strength, this->at(strength));
  for (const auto& [strength, lambda] : curve_) lambda_ = std::max(lambda_, lambda);
  const double full = range().high;
  const double whole = std::max(0.0, (weighting.whitener * (observed(full) - observed(none()))).squaredNorm() - noise(full));
  kappa_ = whole > 0 ? std::min(1.0, std::sqrt(this->at(full) / whole)) : 0;
}

StrengthRange Visibility::range() const {
  return alternative_.prior.value_or(alternative_.freed ? StrengthRange{-1, 1} : alternative_.range);
}

std::vector<double> Visibility::strengths() const {
  const StrengthRange all = range();
  if (alternative_.freed) return {all.low, all.high};
  std::vector<double> out;
  for (int k = all.low < 0 ? -kSteps : 0; k <= kSteps; ++k) out.push_back((k < 0 ? -all.low : all.high) * k / kSteps);
  return out;
}

double Visibility::none() const {
  if (!alternative_.freed) return 0;
  const Coordinate& c = problem_.data.theta[*alternative_.freed];
  return c.coded(c.prior_mean);
}

double Visibility::lambda_high() const {
  double most = 0;
  for (const double strength : strengths()) most = std::max(most, high(strength));
  return most;
}

/// Of what the candidate adds to those beside it.
double Visibility::leverage(double strength) const {
  std::vector<ActiveCandidate> on = beside_;
  on.push_back({*alternative_.candidate, strength});
  return surrogate_.leverage_of(coded_, on, beside_);
}

double Visibility::noise(double strength) const { return alternative_.freed ? 0 : run_noise_ * leverage(strength); }

VectorXd Visibility::observed(double strength) const {
  std::vector<ActiveCandidate> on = beside_;
  VectorXd moved = coded_;
  if (alternative_.freed)
    moved[*alternative_.freed] = strength;
  else
    on.push_back({*alternative_.candidate, strength});
  return surrogate_.at(moved, on);
}

Visibility::Rest Visibility::rest(double strength) const {
  const VectorXd y = observed(strength);
  const FitResult fit = base_.fit(y);
  return {weighting_.whitener * (y - surrogate_.at(fit.coded, base_.active(fit))), fit.q};
}

double Visibility::high(double strength) const {
  if (alternative_.freed) return at(strength);
  const double h = leverage(strength), degrees = static_cast<double>(surrogate_.degrees());
  const Rest left = rest(strength);
  const double along = left.white.squaredNorm(), seen = std::max(0.0, left.square - noise(strength));
  const double a = 2 * h * h * run_covariance_.squaredNorm() * (1 + 1 / std::max(1.0, degrees));
  const double b = along > 0 ? 4 * h * left.white.dot(run_covariance_ * left.white) / along : 0, bend = 0.5 * base::kNormal90 * b;
  return seen + base::kNormal90 * (bend + std::sqrt(a + b * seen + bend * bend));
}

double Visibility::at(double strength) const { return std::max(0.0, rest(strength).square - noise(strength)); }

}  // namespace millscope::naming
