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
  for (const double strength : strengths()) seen_.push_back(look(strength));
}

const Visibility::Seen& Visibility::best() const {
  return *std::max_element(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) { return a.lambda < b.lambda; });
}

double Visibility::kappa() const {
  const Seen& at = best();
  const double whole = (weighting_.whitener * (observed(at.strength) - observed(none()))).squaredNorm() - run_noise_ * at.h;
  return whole > 0 ? std::min(1.0, std::sqrt(at.lambda / whole)) : 0;
}

std::vector<std::pair<double, double>> Visibility::curve() const {
  std::vector<std::pair<double, double>> out;
  for (const Seen& s : seen_) out.emplace_back(s.strength, s.lambda);
  return out;
}

std::vector<double> Visibility::strengths() const {
  const StrengthRange all = alternative_.prior.value_or(alternative_.freed ? StrengthRange{-1, 1} : alternative_.range);
  if (alternative_.freed) return {all.low, all.high};
  if (all.low == all.high) return {0, all.high};  // on or off
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
  for (const Seen& s : seen_) most = std::max(most, high(s));
  return most;
}

/// Of what the candidate adds to those beside it.
double Visibility::leverage(double strength) const {
  if (alternative_.freed) return 0;
  std::vector<ActiveCandidate> on = beside_;
  on.push_back({*alternative_.candidate, strength});
  return surrogate_.leverage_of(coded_, on, beside_);
}

VectorXd Visibility::observed(double strength) const {
  std::vector<ActiveCandidate> on = beside_;
  VectorXd moved = coded_;
  if (alternative_.freed)
    moved[*alternative_.freed] = strength;
  else
    on.push_back({*alternative_.candidate, strength});
  return surrogate_.at(moved, on);
}

Visibility::Seen Visibility::look(double strength) const {
  const VectorXd y = observed(strength);
  const FitResult fit = base_.fit(y);
  Seen seen{strength, weighting_.whitener * (y - surrogate_.at(fit.coded, base_.active(fit))), 0, leverage(strength)};
  seen.lambda = std::max(0.0, fit.q - run_noise_ * seen.h);
  return seen;
}

double Visibility::high(const Seen& seen) const {
  const double degrees = static_cast<double>(surrogate_.degrees()), along = seen.white.squaredNorm();
  const double a = 2 * seen.h * seen.h * run_covariance_.squaredNorm() * (1 + 1 / std::max(1.0, degrees));
  const double b = along > 0 ? 4 * seen.h * seen.white.dot(run_covariance_ * seen.white) / along : 0, bend = 0.5 * base::kNormal90 * b;
  return seen.lambda + base::kNormal90 * (bend + std::sqrt(a + b * seen.lambda + bend * bend));
}

double Visibility::at(double strength) const { return look(strength).lambda; }

}  // namespace millscope::naming
