#include "studies/diagnose/naming/fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::naming {
namespace {

constexpr int kIterations = 40;
constexpr double kFinished = 1e-9;   // of Q, relative
constexpr double kRounding = 1e-13;  // of the largest diagonal element, where columns that go together leave G singular
constexpr double kReliable = 0.3;    // of 1 − μ: below it the correction fades, chosen on made-up banks
constexpr double kSure = 1 - kReliable;
constexpr std::size_t kDescents = 3;
constexpr int kLevels = 3;  // of the grid of starting points, for each flat coordinate

/// Whether every μ of A V = B V diag(μ) lies below a limit, B positive definite.
bool below(double limit, const MatrixXd& a, const MatrixXd& b) { return Eigen::LLT<MatrixXd>(limit * b - a).info() == Eigen::Success; }

}  // namespace

Weighting::Weighting(const MatrixXd& recording, const Surrogate& surrogate, double longer)
    : run(surrogate.residual_covariance(recording)),
      covariance(recording / longer + surrogate.error_covariance(recording)),
      whitener(naming::whitener(covariance)),
      run_noise((whitener * run * whitener.transpose()).trace()) {}

Model::Model(const BankData& data, const Surrogate& surrogate, const Weighting& weighting, const Switched& switched)
    : surrogate_(&surrogate),
      weighting_(&weighting),
      active_(switched.on),
      columns_(surrogate.features().columns(switched.on)),
      exact_(switched.exact),
      theta_(std::ssize(data.theta)) {
  list_products();
  use(weighting.whitener * surrogate.coefficients()(columns_, Eigen::all).transpose());
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

void Model::list_products() {
  const Features& features = surrogate_->features();
  std::vector<Index> place(features.factors(), -1);  // strengths that are not on have none
  place[0] = 0;
  for (Index i = 0; i < theta_; ++i) place[features.factor_of_coordinate(i)] = 1 + i;
  for (Index k = 0; k < std::ssize(active_); ++k) {
    place[features.factor_of_strength(active_[k])] = 1 + theta_ + k;
    place[features.factor_of_square(active_[k])] = 1 + theta_ + std::ssize(active_) + k;
  }
  for (const Index column : columns_) {
    const Product& p = features.of_column(column);
    products_.push_back({place[p.one], place[p.other]});
  }
}

void Model::use(const MatrixXd& whitened) {
  qr_.compute(whitened);
  const Index kept = std::min(qr_.rows(), qr_.cols());
  r_ = qr_.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  corrected_ = !exact_ && r_.cols() > surrogate_->features().base_size() && r_.rows() == r_.cols();
  if (corrected_) correct();
}

/// tr(Σ⁻¹ S) (h(u, s) − h(u, 0)) = xᵀ D x with the features x and D = tr(Σ⁻¹ S) C less its block of the base. What of the candidates'
/// slopes the base could not do itself has the squares G_e in noise units; with C_e V = G_e V diag(μ) and Vᵀ G_e V = 1 a direction of V is
/// reliable by 1 − μ, about the part of its square that is no chance. Where that is below `kReliable` chance alone often leaves as much,
/// and D has less and less of it, nothing at μ = 1: D = [0, C_be T; Tᵀ C_eb, Tᵀ C_e T], T = V diag(t) Vᵀ G_e.
MatrixXd Model::chance_of_slopes(double ridge) const {
  const Index base = surrogate_->features().base_size(), own = r_.cols() - base;
  const MatrixXd c = weighting_->run_noise * surrogate_->coefficient_error()(columns_, columns_);
  const MatrixXd slopes = r_.bottomRightCorner(own, own), c_e = c.bottomRightCorner(own, own);
  const MatrixXd g_e = slopes.transpose() * slopes + ridge * MatrixXd::Identity(own, own);
  MatrixXd taper = MatrixXd::Identity(own, own);
  if (!below(kSure, c_e, g_e)) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(c_e, g_e);
    const VectorXd t = ((1 - solver.eigenvalues().array()) / kReliable).max(0).min(1).sqrt();
    taper = solver.eigenvectors() * t.asDiagonal() * solver.eigenvectors().transpose() * g_e;
  }
  MatrixXd d = MatrixXd::Zero(r_.cols(), r_.cols());
  d.topRightCorner(base, own) = c.topRightCorner(base, own) * taper;
  d.bottomLeftCorner(own, base) = d.topRightCorner(base, own).transpose();
  d.bottomRightCorner(own, own) = taper.transpose() * c_e * taper;
  return d;
}

/// |W (y − Bᵀx)|² − xᵀ D x is a sum of squares and a constant, too: with G = RᵀR
///
///   |R x − z|² − xᵀ D x = |R' x − z'|² + |z|² − |z'|²,  R'ᵀR' = G − D, R'ᵀz' = Rᵀz
///
/// Rarely less than `kReliable` of a direction is sure, D V = G V diag(μ) with a μ above `kSure`; then less of D is taken.
void Model::correct() {
  MatrixXd g = r_.transpose() * r_;
  const double ridge = kRounding * g.diagonal().maxCoeff();
  g.diagonal().array() += ridge;
  const MatrixXd d = chance_of_slopes(ridge);
  double whole = 1;
  if (!below(kSure, d, g)) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(d, g, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
    whole = kSure / std::max(kSure, solver.eigenvalues().maxCoeff());
  }
  const Eigen::LLT<MatrixXd> rest(g - whole * d);
  assert(rest.info() == Eigen::Success && "a part of G is never all of it");
  r_ = rest.matrixU();
}

/// z, or z', of observations in noise units.
VectorXd Model::target(const VectorXd& white) const {
  VectorXd z = white;
  z.applyOnTheLeft(qr_.householderQ().adjoint());
  z.conservativeResize(r_.rows());
  if (!corrected_) return z;
  const auto first = qr_.matrixQR().topRows(r_.rows()).triangularView<Eigen::Upper>();
  return r_.triangularView<Eigen::Upper>().transpose().solve(VectorXd(first.transpose() * z));
}

Model Model::with(const MatrixXd& whitened) const {
  Model out = *this;
  out.use(whitened(Eigen::all, columns_));
  return out;
}

/// What a fit works in, so that none of its steps asks for memory.
struct Model::Work {
  VectorXd z, factor, feature, residual, tried, gradient, next;
  MatrixXd jacobian, normal, damped;
  Eigen::LDLT<MatrixXd> damped_factor;

  /// Factors of t: 1 before it, the strengths' squares after it.
  void at(const VectorXd& t, Index strengths) {
    factor.resize(1 + t.size() + strengths);
    factor[0] = 1;
    factor.segment(1, t.size()) = t;
    factor.tail(strengths) = t.tail(strengths).cwiseAbs2();
  }
};

void Model::residual(const VectorXd& t, Work& work, VectorXd& out) const {
  const Index fitted = r_.rows();
  work.at(t, std::ssize(active_));
  work.feature.resize(r_.cols());
  for (Index k = 0; k < r_.cols(); ++k) work.feature[k] = work.factor[products_[k].one] * work.factor[products_[k].other];
  out.resize(fitted + theta_);
  out.head(fitted) = -work.z;
  out.head(fitted).noalias() += r_ * work.feature;
  out.tail(theta_) = weight_.head(theta_).cwiseProduct(t.head(theta_) - prior_.head(theta_));
}

void Model::jacobian(const VectorXd& t, Work& work) const {
  const Index fitted = r_.rows();
  work.at(t, std::ssize(active_));
  work.jacobian.setZero(fitted + theta_, t.size());
  const auto add = [&](Index factor, double rest, Index column) {
    if (factor == 0) return;
    const bool square = factor > t.size();
    const Index of = square ? factor - std::ssize(active_) : factor;
    work.jacobian.col(of - 1).head(fitted) += (square ? 2 * work.factor[of] : 1) * rest * r_.col(column);
  };
  for (Index k = 0; k < r_.cols(); ++k) {
    const auto [one, other] = products_[k];
    add(one, work.factor[other], k), add(other, work.factor[one], k);
  }
  for (Index i = 0; i < theta_; ++i) work.jacobian(fitted + i, i) = weight_[i];
}

/// Levenberg's and Marquardt's steps, coordinates at a limit held while the gradient pushes outward.
double Model::descend(const Limits& limits, VectorXd& t, Work& work) const {
  VectorXd &r = work.residual, &tried = work.tried, &gradient = work.gradient, &next = work.next;
  MatrixXd &normal = work.normal, &damped = work.damped;
  const MatrixXd& j = work.jacobian;
  residual(t, work, r);
  double q = r.squaredNorm(), damping = 1e-3;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    jacobian(t, work);
    gradient = j.transpose().lazyProduct(r);
    normal = j.transpose().lazyProduct(j);
    for (Index i = 0; i < t.size(); ++i) {
      const bool held =
          limits.low[i] == limits.high[i] || (t[i] <= limits.low[i] && gradient[i] > 0) || (t[i] >= limits.high[i] && gradient[i] < 0);
      if (held) normal.row(i).setZero(), normal.col(i).setZero(), normal(i, i) = 1, gradient[i] = 0;
    }
    bool better = false;
    for (; damping < 1e8 && !better; damping *= 8) {
      damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-9).matrix();
      work.damped_factor.compute(damped);
      next = work.damped_factor.solve(gradient);
      next = (t - next).cwiseMax(limits.low).cwiseMin(limits.high);
      residual(next, work, tried);
      const double q_next = tried.squaredNorm();
      if (!(q_next < q)) continue;
      better = true;
      damping /= 64;
      const bool finished = q - q_next < kFinished * (1 + q);
      t.swap(next), r.swap(tried), q = q_next;
      if (finished) return q;
    }
    if (!better) return q;
  }
  return q;
}

/// A grid over the flat coordinates, the others at their priors: one starting point a column.
MatrixXd Model::starts(const Limits& limits) const {
  MatrixXd out = prior_.cwiseMax(limits.low).cwiseMin(limits.high);
  for (Index i = 0; i < prior_.size(); ++i) {
    if (weight_[i] > 0 || limits.low[i] == limits.high[i]) continue;
    const Index each = out.cols();
    out = out.replicate(1, kLevels).eval();
    for (Index k = 0; k < out.cols(); ++k) {
      const auto level = static_cast<double>(k / each);
      out(i, k) = limits.low[i] + (limits.high[i] - limits.low[i]) * (0.5 + level) / kLevels;
    }
  }
  return out;
}

FitResult Model::fit_within(const Limits& limits, const VectorXd& observed) const {
  const VectorXd white = weighting_->whitener * observed;
  Work work;
  work.z = target(white);
  const double beyond = white.squaredNorm() - work.z.squaredNorm();  // Q less the sum of squares
  const MatrixXd start = starts(limits);
  std::vector<std::pair<double, Index>> tried;
  VectorXd t;
  for (Index k = 0; k < start.cols(); ++k) {
    t = start.col(k);
    residual(t, work, work.residual);
    tried.emplace_back(work.residual.squaredNorm(), k);
  }
  const std::size_t descents = std::min(kDescents, tried.size());
  std::partial_sort(tried.begin(), tried.begin() + static_cast<std::ptrdiff_t>(descents), tried.end());
  FitResult best;
  best.q = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < descents; ++k) {
    t = start.col(tried[k].second);
    const double q = descend(limits, t, work) + beyond;
    if (q >= best.q) continue;
    best.q = q;
    best.coded = t.head(theta_);
    best.strengths.assign(t.data() + theta_, t.data() + t.size());
  }
  return best;
}

FitResult Model::fit_holding(Index coordinate, double value, const VectorXd& observed) const {
  Limits limits{low_, high_};
  limits.low[coordinate] = limits.high[coordinate] = value;
  return fit_within(limits, observed);
}

std::vector<ActiveCandidate> Model::active(const FitResult& fit) const {
  std::vector<ActiveCandidate> out;
  for (std::size_t k = 0; k < active_.size(); ++k) out.push_back({active_[k], fit.strengths[k]});
  return out;
}

}  // namespace millscope::naming
