#include "studies/diagnose/visibility.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace millscope::diagnose {
namespace {

constexpr double kFlat = 1e-6;  // weight of coordinates without a prior, so that what the data leave open does not run away

}  // namespace

Visibility::Visibility(const Problem& problem, const Surrogate& surrogate, const MatrixXd& whitening, const VectorXd& coded, int rival)
    : problem_(problem),
      surrogate_(surrogate),
      whitening_(whitening),
      coded_(coded),
      rival_(problem.rivals[static_cast<std::size_t>(rival)]) {
  const Index d = coded.size(), n = whitening.rows();
  tangent_ = MatrixXd::Zero(n + d, d);
  for (Index i = 0; i < d; ++i) {
    if (i == rival_.freed) continue;
    VectorXd up = coded, down = coded;
    up[i] += 0.5, down[i] -= 0.5;
    tangent_.col(i).head(n) = whitening * (surrogate.at(up) - surrogate.at(down));
    const Coordinate& c = problem.data.theta[static_cast<std::size_t>(i)];
    tangent_(n + i, i) = c.nuisance() ? c.prior_weight() : kFlat;
  }
  run_covariance_ = whitening * surrogate.residual_covariance() * whitening.transpose();
  run_noise_ = run_covariance_.trace() * static_cast<double>(n - d) / static_cast<double>(n);
  const std::vector<double> far = ends();
  const double full = far.front();
  lambda_ = orthogonal(full);
  const double whole = std::max(0.0, effect(full).squaredNorm() - noise(full));
  kappa_ = whole > 0 ? std::min(1.0, std::sqrt(lambda_ / whole)) : 0;
  if (far.size() > 1) lambda_ = std::max(lambda_, orthogonal(far.back()));
}

std::vector<double> Visibility::ends() const {
  if (rival_.freed >= 0) return {1, -1};
  if (rival_.range.low < 0) return {rival_.range.high, rival_.range.low};
  return {rival_.range.high};
}

double Visibility::lambda_high() const {
  double most = 0;
  for (const double end : ends()) most = std::max(most, high(end));
  return most;
}

double Visibility::noise(double share) const {
  return rival_.freed >= 0 ? 0 : run_noise_ * surrogate_.leverage_of(coded_, {{rival_.candidate, share}});
}

VectorXd Visibility::effect(double share) const {
  VectorXd s = VectorXd::Zero(whitening_.rows() + coded_.size());
  if (rival_.freed >= 0) {
    const Coordinate& c = problem_.data.theta[static_cast<std::size_t>(rival_.freed)];
    VectorXd moved = coded_, still = coded_;
    moved[rival_.freed] = share, still[rival_.freed] = c.coded(c.prior_mean);
    s.head(whitening_.rows()) = whitening_ * (surrogate_.at(moved) - surrogate_.at(still));
  } else {
    s.head(whitening_.rows()) = whitening_ * (surrogate_.at(coded_, {{rival_.candidate, share}}) - surrogate_.at(coded_));
  }
  return s;
}

VectorXd Visibility::rest(const VectorXd& s) const { return s - tangent_ * tangent_.completeOrthogonalDecomposition().solve(s); }

double Visibility::high(double share) const {
  if (rival_.freed >= 0) return orthogonal(share);
  const double h = surrogate_.leverage_of(coded_, {{rival_.candidate, share}}), degrees = static_cast<double>(surrogate_.degrees());
  const VectorXd s = rest(effect(share)).head(run_covariance_.rows());
  const double a = 2 * h * h * run_covariance_.squaredNorm() * (1 + 1 / std::max(1.0, degrees));
  const double b = s.squaredNorm() > 0 ? 4 * h * s.dot(run_covariance_ * s) / s.squaredNorm() : 0;
  const double seen = orthogonal(share), bend = 0.5 * kNormal90 * b;
  return seen + kNormal90 * (bend + std::sqrt(a + b * seen + bend * bend));
}

double Visibility::orthogonal(double share) const { return std::max(0.0, rest(effect(share)).squaredNorm() - noise(share)); }

}  // namespace millscope::diagnose
