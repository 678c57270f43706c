#include "studies/diagnose/naming/fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/error.hpp"

namespace millscope::naming {
namespace {

constexpr int kIterations = 40;
constexpr double kFinished = 1e-9;   // of Q, relative
constexpr double kRounding = 1e-13;  // of the largest diagonal element, where more coefficients than observables leave G singular
constexpr double kReliable = 0.3;    // of 1 − μ: below it the correction fades, chosen on made-up banks
constexpr std::size_t kDescents = 3;
constexpr int kLevels = 3;  // of the grid of starting points, for each flat coordinate

}  // namespace

MatrixXd factor(const MatrixXd& covariance) {
  const Eigen::LLT<MatrixXd> llt(covariance);
  if (llt.info() != Eigen::Success) {
    throw base::UserError(
        "the covariance of the observables is not positive definite; lengthen the recording or leave groups out (objective.without)");
  }
  return llt.matrixL();
}

MatrixXd whitener(const MatrixXd& covariance) {
  return factor(covariance).triangularView<Eigen::Lower>().solve(MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

Weighting::Weighting(const MatrixXd& recording, const Surrogate& surrogate, double longer)
    : run(surrogate.residual_covariance(recording)),
      covariance(recording / longer + surrogate.error_covariance(recording)),
      whitener(naming::whitener(covariance)),
      run_noise((whitener * run * whitener.transpose()).trace()) {}

Model::Model(const BankData& data, const Surrogate& surrogate, const Weighting& weighting, const Switched& switched)
    : surrogate_(&surrogate),
      features_(&surrogate.features()),
      weighting_(&weighting),
      active_(switched.on),
      columns_(surrogate.features().columns(switched.on)),
      exact_(switched.exact),
      theta_(std::ssize(data.theta)) {
  use(surrogate.coefficients());
  const Index all = theta_ + std::ssize(active_);
  low_ = VectorXd::Constant(all, -1), high_ = VectorXd::Constant(all, 1);
  prior_ = VectorXd::Zero(all), weight_ = VectorXd::Zero(all);
  for (Index i = 0; i < theta_; ++i) {
    const Coordinate& c = data.theta[i];
    if (!c.nuisance()) continue;
    prior_[i] = c.coded(c.prior_mean);
    if (i != switched.freed) weight_[i] = c.prior_weight();
  }
  for (Index k = 0; k < std::ssize(active_); ++k) {
    const StrengthRange& range = switched.ranges[active_[k]];
    low_[theta_ + k] = range.low;
    high_[theta_ + k] = range.high;
  }
}

void Model::use(const MatrixXd& coefficients) {
  const MatrixXd& w = weighting_->whitener;
  const Index kept = std::min<Index>(std::ssize(columns_), w.rows());
  const Eigen::HouseholderQR<MatrixXd> qr(w * coefficients(columns_, Eigen::all).transpose());
  r_ = qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  qt_ = (qr.householderQ() * MatrixXd::Identity(w.rows(), kept)).transpose();
  if (!exact_ && r_.cols() > features_->base_size() && r_.rows() == r_.cols()) correct();
}

/// tr(Σ⁻¹ S) (h(u, s) − h(u, 0)) = xᵀ D x with the features x and D = tr(Σ⁻¹ S) C less its block of the base. What of the candidates'
/// slopes the base could not do itself has the squares G_e in noise units; with C_e V = G_e V diag(μ) and Vᵀ G_e V = 1 a direction of V is
/// reliable by 1 − μ, about the part of its square that is no chance. Where that is below `kReliable` chance alone often leaves as much,
/// and D has less and less of it, nothing at μ = 1: D = [0, C_be T; Tᵀ C_eb, Tᵀ C_e T], T = V diag(t) Vᵀ G_e.
MatrixXd Model::chance_of_slopes(double ridge) const {
  const Index base = features_->base_size(), own = r_.cols() - base;
  const MatrixXd c = weighting_->run_noise * surrogate_->coefficient_error()(columns_, columns_);
  const MatrixXd slopes = r_.bottomRightCorner(own, own), c_e = c.bottomRightCorner(own, own);
  const MatrixXd g_e = slopes.transpose() * slopes + ridge * MatrixXd::Identity(own, own);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(c_e, g_e);
  const VectorXd t = ((1 - solver.eigenvalues().array()) / kReliable).max(0).min(1).sqrt();
  const MatrixXd taper = solver.eigenvectors() * t.asDiagonal() * solver.eigenvectors().transpose() * g_e;
  MatrixXd d = MatrixXd::Zero(r_.cols(), r_.cols());
  d.topRightCorner(base, own) = c.topRightCorner(base, own) * taper;
  d.bottomLeftCorner(own, base) = d.topRightCorner(base, own).transpose();
  d.bottomRightCorner(own, own) = taper.transpose() * c_e * taper;
  return d;
}

/// |W (y − Bᵀx)|² − xᵀ D x is a sum of squares and a constant, too: with G = RᵀR, D V = G V diag(μ) and Vᵀ G V = 1
///
///   |R x − z|² − xᵀ D x = |R' x − z'|² + |z|² − |z'|²,  R' = (1 − μ)^½ Vᵀ G,  z' = (1 − μ)^−½ Vᵀ Rᵀ z
void Model::correct() {
  MatrixXd g = r_.transpose() * r_;
  const double ridge = kRounding * g.diagonal().maxCoeff();
  g.diagonal().array() += ridge;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(chance_of_slopes(ridge), g);
  const Eigen::ArrayXd mu = solver.eigenvalues().array();
  const double sure = 1 - kReliable, whole = std::min(1.0, sure / std::max(sure, mu.maxCoeff()));  // rarely less than 1
  const VectorXd root = (1 - whole * mu).sqrt();
  const MatrixXd vt = solver.eigenvectors().transpose();
  qt_ = (root.cwiseInverse().asDiagonal() * vt * r_.transpose() * qt_).eval();
  r_ = root.asDiagonal() * vt * g;
}

Model Model::with(const MatrixXd& coefficients) const {
  Model out = *this;
  out.use(coefficients);
  return out;
}

VectorXd Model::features(const VectorXd& t) const {
  const VectorXd u = t.head(theta_);
  VectorXd x(r_.cols());
  x.head(features_->base_size()) = features_->base(u);
  Index next = features_->base_size();
  for (Index k = 0; k < std::ssize(active_); ++k) {
    const Index n = features_->count(active_[k]);
    x.segment(next, n) = features_->block(active_[k], u, t[theta_ + k]);
    next += n;
  }
  if (next < x.size()) x[next] = t[theta_] * t[theta_ + 1];  // the product of two that have runs together
  return x;
}

VectorXd Model::residual(const VectorXd& t, const Target& target) const {
  VectorXd out(r_.rows() + theta_);
  out.head(r_.rows()) = r_ * features(t) - target.z;
  out.tail(theta_) = (weight_.array() * (t - prior_).array()).matrix().head(theta_);
  return out;
}

/// Features are quadratic in every coordinate: central differences are exact but for rounding.
MatrixXd Model::jacobian(const VectorXd& t) const {
  constexpr double kStep = 0.5;
  MatrixXd out = MatrixXd::Zero(r_.rows() + theta_, t.size());
  for (Index i = 0; i < t.size(); ++i) {
    VectorXd up = t, down = t;
    up[i] += kStep, down[i] -= kStep;
    out.col(i).head(r_.rows()) = r_ * (features(up) - features(down));
    if (i < theta_) out(r_.rows() + i, i) = weight_[i];
  }
  return out;
}

/// Levenberg's and Marquardt's steps, coordinates at a limit held while the gradient pushes outward.
double Model::descend(VectorXd& t, const Target& target) const {
  VectorXd r = residual(t, target);
  double q = r.squaredNorm(), damping = 1e-3;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const MatrixXd j = jacobian(t);
    VectorXd gradient = j.transpose() * r;
    MatrixXd normal = j.transpose() * j;
    for (Index i = 0; i < t.size(); ++i) {
      const bool held = low_[i] == high_[i] || (t[i] <= low_[i] && gradient[i] > 0) || (t[i] >= high_[i] && gradient[i] < 0);
      if (held) normal.row(i).setZero(), normal.col(i).setZero(), normal(i, i) = 1, gradient[i] = 0;
    }
    bool better = false;
    for (; damping < 1e8 && !better; damping *= 8) {
      MatrixXd damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-9).matrix();
      const VectorXd next = (t - damped.ldlt().solve(gradient)).cwiseMax(low_).cwiseMin(high_);
      const VectorXd r_next = residual(next, target);
      const double q_next = r_next.squaredNorm();
      if (!(q_next < q)) continue;
      better = true;
      damping /= 64;
      const bool finished = q - q_next < kFinished * (1 + q);
      t = next, r = r_next, q = q_next;
      if (finished) return q;
    }
    if (!better) return q;
  }
  return q;
}

std::vector<VectorXd> Model::starts() const {
  std::vector<VectorXd> out{prior_.cwiseMax(low_).cwiseMin(high_)};
  for (Index i = 0; i < low_.size(); ++i) {
    if (weight_[i] > 0 || low_[i] == high_[i]) continue;
    std::vector<VectorXd> more;
    for (const VectorXd& t : out) {
      for (int level = 0; level < kLevels; ++level) {
        more.push_back(t);
        more.back()[i] = low_[i] + (high_[i] - low_[i]) * (0.5 + level) / kLevels;
      }
    }
    out = std::move(more);
  }
  return out;
}

FitResult Model::fit(const VectorXd& observed) const {
  const VectorXd white = weighting_->whitener * observed;
  Target target{qt_ * white, 0};
  target.beyond = white.squaredNorm() - target.z.squaredNorm();
  std::vector<std::pair<double, VectorXd>> tried;
  for (VectorXd& t : starts()) {
    const double q = residual(t, target).squaredNorm();
    tried.emplace_back(q, std::move(t));
  }
  const std::size_t descents = std::min(kDescents, tried.size());
  std::partial_sort(tried.begin(), tried.begin() + static_cast<std::ptrdiff_t>(descents), tried.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  FitResult best;
  best.q = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < descents; ++k) {
    VectorXd t = tried[k].second;
    const double q = descend(t, target) + target.beyond;
    if (q >= best.q) continue;
    best.q = q;
    best.coded = t.head(theta_);
    best.strengths.assign(t.data() + theta_, t.data() + t.size());
  }
  return best;
}

FitResult Model::fit_holding(Index coordinate, double value, const VectorXd& observed) const {
  Model held = *this;
  held.low_[coordinate] = held.high_[coordinate] = value;
  return held.fit(observed);
}

std::vector<ActiveCandidate> Model::active(const FitResult& fit) const {
  std::vector<ActiveCandidate> out;
  for (std::size_t k = 0; k < active_.size(); ++k) out.push_back({active_[k], fit.strengths[k]});
  return out;
}

}  // namespace millscope::naming
