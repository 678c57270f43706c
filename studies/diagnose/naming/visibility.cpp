#include "studies/diagnose/naming/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::diagnose {
namespace {

constexpr int kSteps = 8;  // of the curve, on each side of zero

/// The priors about θ, as noise-free data of it have them; a freed nuisance keeps its own.
BankData about(BankData data, const VectorXd& coded, Index freed) {
  for (Index i = 0; i < coded.size(); ++i) {
    Coordinate& c = data.theta[static_cast<std::size_t>(i)];
    if (!c.nuisance() || i == freed) continue;
    const double before = c.prior_mean;
    c.prior_mean = c.natural(coded[i]);
    if (c.logarithmic) c.prior_sigma *= c.prior_mean / before;  // the weight is that of the logarithm
  }
  return data;
}

}  // namespace

Visibility::Visibility(const Problem& problem, const Surrogate& surrogate, const Weighting& weighting, const VectorXd& coded, int rival)
    : problem_(problem),
      surrogate_(surrogate),
      weighting_(weighting),
      coded_(coded),
      rival_(problem.rivals[static_cast<std::size_t>(rival)]),
      base_(about(problem.data, coded, rival_.freed), surrogate, weighting, {}) {
  const auto n = static_cast<double>(weighting.whitener.rows());
  run_covariance_ = weighting.whitener * weighting.run * weighting.whitener.transpose();
  run_noise_ = weighting.run_noise * (n - static_cast<double>(coded.size())) / n;
  const std::vector<double> far = ends();
  const double full = far.front();
  lambda_ = at(full);
  const double whole = std::max(0.0, (weighting.whitener * (observed(full) - observed(none()))).squaredNorm() - noise(full));
  kappa_ = whole > 0 ? std::min(1.0, std::sqrt(lambda_ / whole)) : 0;
  if (far.size() > 1) lambda_ = std::max(lambda_, at(far.back()));
}

std::vector<double> Visibility::ends() const {
  if (rival_.freed >= 0) return {1, -1};
  if (rival_.range.low < 0) return {rival_.range.high, rival_.range.low};
  return {rival_.range.high};
}

double Visibility::none() const {
  if (rival_.freed < 0) return 0;
  const Coordinate& c = problem_.data.theta[static_cast<std::size_t>(rival_.freed)];
  return c.coded(c.prior_mean);
}

double Visibility::lambda_high() const {
  double most = 0;
  for (const double end : ends()) most = std::max(most, high(end));
  return most;
}

double Visibility::noise(double share) const {
  return rival_.freed >= 0 ? 0 : run_noise_ * surrogate_.leverage_of(coded_, {{rival_.candidate, share}});
}

VectorXd Visibility::observed(double share) const {
  if (rival_.freed < 0) return surrogate_.at(coded_, {{rival_.candidate, share}});
  VectorXd moved = coded_;
  moved[rival_.freed] = share;
  return surrogate_.at(moved);
}

Visibility::Rest Visibility::rest(double share) const {
  const VectorXd y = observed(share);
  const FitResult fit = base_.fit(y);
  return {weighting_.whitener * (y - surrogate_.at(fit.coded)), fit.q};
}

double Visibility::high(double share) const {
  if (rival_.freed >= 0) return at(share);
  const double h = surrogate_.leverage_of(coded_, {{rival_.candidate, share}}), degrees = static_cast<double>(surrogate_.degrees());
  const Rest left = rest(share);
  const double along = left.white.squaredNorm(), seen = std::max(0.0, left.square - noise(share));
  const double a = 2 * h * h * run_covariance_.squaredNorm() * (1 + 1 / std::max(1.0, degrees));
  const double b = along > 0 ? 4 * h * left.white.dot(run_covariance_ * left.white) / along : 0, bend = 0.5 * kNormal90 * b;
  return seen + kNormal90 * (bend + std::sqrt(a + b * seen + bend * bend));
}

double Visibility::at(double share) const { return std::max(0.0, rest(share).square - noise(share)); }

std::vector<std::pair<double, double>> Visibility::curve() const {
  std::vector<std::pair<double, double>> out;
  if (rival_.freed >= 0) return out;
  const std::vector<double> far = ends();
  const double low = far.size() > 1 ? far.back() : 0;
  for (int k = low < 0 ? -kSteps : 0; k <= kSteps; ++k) {
    const double share = (k < 0 ? -low : far.front()) * k / kSteps;
    out.emplace_back(share, at(share));
  }
  return out;
}

}  // namespace millscope::diagnose
