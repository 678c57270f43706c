#include "studies/emulate/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "kernel/base/error.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kCentres = 120;
constexpr int kRounds = 3;
constexpr double kFraction = 0.05;

/// exp((l − max)/T) with the smallest T ≥ 1 at which enough of the points count.
VectorXd flattened(const VectorXd& log_weights) {
  const double most = log_weights.maxCoeff();
  if (!std::isfinite(most))
    throw base::UserError("no parameters in the ranges explain the recording at all: the emulator's covariance is singular there");
  const auto enough = [](const VectorXd& w) { return w.sum() * w.sum() >= kFraction * static_cast<double>(w.size()) * w.squaredNorm(); };
  VectorXd weights = (log_weights.array() - most).exp();
  double temperature = 1;
  while (!enough(weights) && temperature < 1e12) {
    temperature *= 1.5;
    weights = ((log_weights.array() - most) / temperature).exp();
  }
  return weights;
}

/// Number of the point at which the running sum of the weights passes a part of the whole.
Index pick(const VectorXd& weights, double part) {
  double left = part * weights.sum();
  Index last = 0;
  for (Index i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    last = i;
    left -= weights[i];
    if (left < 0) break;
  }
  return last;
}

/// Mean square of the differences to the nearest tenth.
MatrixXd local_covariance(const MatrixXd& centres) {
  const Index n = centres.cols(), p = centres.rows();
  const Index near = std::max<Index>(2 * p, n / 10);
  MatrixXd sum = MatrixXd::Zero(p, p);
  const VectorXd unit =
      ((centres.colwise() - centres.rowwise().mean()).rowwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt().cwiseMax(1e-9);
  const MatrixXd scaled = unit.cwiseInverse().asDiagonal() * centres;
  std::vector<std::pair<double, Index>> distance(n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) distance[j] = {(scaled.col(i) - scaled.col(j)).squaredNorm(), j};
    std::sort(distance.begin(), distance.end());
    for (Index k = 0; k < near; ++k) {
      const VectorXd d = centres.col(distance[k].second) - centres.col(i);
      sum += d * d.transpose();
    }
  }
  return sum / static_cast<double>(n * near);
}

}  // namespace

Mixture::Mixture(const LogDensity& density, const MatrixXd& prior_points, base::RandomStream& random) : points_(prior_points) {
  VectorXd log_weights(points_.cols());
  for (Index i = 0; i < points_.cols(); ++i) log_weights[i] = density(points_.col(i));
  weights_ = flattened(log_weights);
  learn(points_, weights_, random);
  for (int round = 1; round < kRounds; ++round) {
    for (Index i = 0; i < points_.cols(); ++i) {
      points_.col(i) = draw(random);
      log_weights[i] = density(points_.col(i)) - log_density(points_.col(i));
    }
    weights_ = flattened(log_weights);
    learn(points_, weights_, random);
  }
}

void Mixture::learn(const MatrixXd& points, const VectorXd& weights, base::RandomStream& random) {
  centres_.resize(points.rows(), kCentres);
  for (Index j = 0; j < kCentres; ++j) {  // one draw from each of equal parts of the sum: evener than independent draws
    const double part = (static_cast<double>(j) + random.uniform()) / static_cast<double>(kCentres);
    centres_.col(j) = points.col(pick(weights, part));
  }
  const Index p = points.rows();
  const Eigen::LLT<MatrixXd> factor(local_covariance(centres_) + 1e-8 * MatrixXd::Identity(p, p));
  root_ = factor.matrixL();
  inverse_root_ = factor.matrixL().solve(MatrixXd::Identity(p, p));
  whitened_ = inverse_root_ * centres_;
  log_scale_ = -root_.diagonal().array().log().sum() - 0.5 * static_cast<double>(p) * std::log(2 * std::numbers::pi) -
               std::log(static_cast<double>(kCentres));
}

VectorXd Mixture::draw(base::RandomStream& random) const {
  const auto centre = static_cast<Index>(random.below(kCentres));
  return centres_.col(centre) + root_ * random.normals(root_.rows());
}

double Mixture::log_density(const VectorXd& coded) const {
  const VectorXd square = 0.5 * (whitened_.colwise() - inverse_root_ * coded).colwise().squaredNorm().transpose();
  const double least = square.minCoeff();
  return log_scale_ - least + std::log((least - square.array()).exp().sum());
}

MatrixXd Mixture::starts(Index count, base::RandomStream& random) const {
  VectorXd weights = weights_;
  MatrixXd starts(points_.rows(), count);
  for (Index c = 0; c < count; ++c) {
    if (!(weights.sum() > 0)) weights = weights_;  // more chains than points
    const Index chosen = pick(weights, random.uniform());
    starts.col(c) = points_.col(chosen);
    weights[chosen] = 0;  // each but once: the chains' steps come from their differences
  }
  return starts;
}

}  // namespace millscope::emulate
