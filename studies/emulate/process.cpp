#include "studies/emulate/process.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// k(r²), and its slope to r².
struct Correlation {
  double value, slope;
};

Correlation correlation(Kernel kernel, double r2) {
  if (kernel == Kernel::squared_exponential) {
    const double e = std::exp(-0.5 * r2);
    return {e, -0.5 * e};
  }
  const double q = std::sqrt(5 * r2), e = std::exp(-q);
  return {(1 + q + 5.0 / 3.0 * r2) * e, -5.0 / 6.0 * (1 + q) * e};
}

/// log |L|·2 of a Cholesky factor.
template <class Factor>
double log_determinant(const Factor& llt) {
  return 2 * llt.matrixLLT().diagonal().array().log().sum();
}

// What is thought of the hyper-parameters before the data speak, as normal distributions of their logarithms. Lengths: about the whole
// range (2 in coded units), by a factor of 2.7. The nugget: a hundredth of the known noise, by a factor of 12; nearly free where no noise
// is known.
struct Belief {
  double centre, deviation;
  double log_density(double x) const { return -0.5 * std::pow((x - centre) / deviation, 2); }
  double slope(double x) const { return -(x - centre) / (deviation * deviation); }
};
constexpr Belief kLength{0.69, 1.0};
constexpr Belief kVariance{-1.2, 4.0};

Belief nugget_belief(const VectorXd& noise) {
  const double mean = noise.mean();
  return mean > 0 ? Belief{std::log(std::max(1e-8, 0.01 * mean)), 2.5} : Belief{std::log(1e-4), 4.0};
}

}  // namespace

Index trend_size(Trend trend, Index parameters) {
  return trend == Trend::quadratic ? (parameters + 1) * (parameters + 2) / 2 : parameters + 1;
}

VectorXd trend_terms(Trend trend, const VectorXd& coded) {
  const Index p = coded.size();
  VectorXd terms(trend_size(trend, p));
  terms[0] = 1;
  terms.segment(1, p) = coded;
  if (trend != Trend::quadratic) return terms;
  Index at = p + 1;
  for (Index j = 0; j < p; ++j) {
    for (Index k = j; k < p; ++k) terms[at++] = coded[j] * coded[k];
  }
  return terms;
}

Process::Process(Sample sample, Shape shape) : sample_(std::move(sample)), shape_(std::move(shape)) {
  const Index n = sample_.output.size();
  per_length_ = (-shape_.log_length).array().exp();
  scaled_ = per_length_.asDiagonal() * sample_.input;
  variance_ = std::exp(shape_.log_variance);
  const double nugget = std::exp(shape_.log_nugget);
  MatrixXd a(n, n), h(n, trend_size(shape_.trend, scaled_.rows()));
  for (Index i = 0; i < n; ++i) {
    a.col(i) = correlations(scaled_.col(i));
    a(i, i) = variance_ + sample_.noise[i] + nugget;
    h.row(i) = trend_terms(shape_.trend, sample_.input.col(i)).transpose();
  }
  const Eigen::LLT<MatrixXd> root(a);
  if (root.info() != Eigen::Success) throw std::domain_error("covariance of the training runs is singular");
  inverse_root_ = root.matrixL().solve(MatrixXd::Identity(n, n));
  trend_root_ = inverse_root_.triangularView<Eigen::Lower>() * h;
  const Eigen::LLT<MatrixXd> trend(trend_root_.transpose() * trend_root_);
  if (trend.info() != Eigen::Success) throw std::domain_error("trend of the training runs is singular");
  trend_inverse_ = trend.solve(MatrixXd::Identity(h.cols(), h.cols()));
  beta_ = trend_inverse_ * (trend_root_.transpose() * (inverse_root_.triangularView<Eigen::Lower>() * sample_.output));
  const VectorXd rest = inverse_root_.triangularView<Eigen::Lower>() * (sample_.output - h * beta_);
  weights_ = inverse_root_.triangularView<Eigen::Lower>().transpose() * rest;  // = α
  log_determinants_ = log_determinant(root) + log_determinant(trend);
}

Process::Value Process::at(const VectorXd& coded) const {
  const VectorXd k = correlations(coded.cwiseProduct(per_length_));
  const VectorXd h = trend_terms(shape_.trend, coded);
  const VectorXd v = inverse_root_.triangularView<Eigen::Lower>() * k;
  const VectorXd t = h - trend_root_.transpose() * v;
  return {h.dot(beta_) + k.dot(weights_), std::max(0.0, variance_ - v.squaredNorm() + t.dot(trend_inverse_ * t))};
}

/// Of a point with all runs, whole arrays at once: this is what a posterior's time goes into.
VectorXd Process::correlations(const VectorXd& scaled) const {
  const Eigen::ArrayXd r2 = (scaled_.colwise() - scaled).colwise().squaredNorm().transpose();
  if (shape_.kernel == Kernel::squared_exponential) return variance_ * (-0.5 * r2).exp();
  const Eigen::ArrayXd q = (5 * r2).sqrt();
  return variance_ * (1 + q + 5.0 / 3.0 * r2) * (-q).exp();
}

Process::LeftOut Process::leave_one_out() const {
  const MatrixXd back = inverse_root_.transpose() * trend_root_;  // A⁻¹H
  const VectorXd q = inverse_root_.colwise().squaredNorm().transpose() - (back * trend_inverse_).cwiseProduct(back).rowwise().sum();
  return {weights_.cwiseQuotient(q), q.cwiseInverse()};
}

double Process::LeftOut::log_density() const {
  return -0.5 * ((2 * std::numbers::pi * variance.array()).log() + residual.array().square() / variance.array()).sum();
}

double Process::log_likelihood(VectorXd* slope) const {
  const Index n = sample_.output.size(), p = shape_.log_length.size();
  const Belief nugget = nugget_belief(sample_.noise);
  double value = -0.5 * (log_determinants_ + sample_.output.dot(weights_)) + kVariance.log_density(shape_.log_variance) +
                 nugget.log_density(shape_.log_nugget);
  for (const double x : shape_.log_length) value += kLength.log_density(x);
  if (slope == nullptr) return value;

  const MatrixXd back = inverse_root_.transpose() * trend_root_;
  MatrixXd m = back * trend_inverse_ * back.transpose();
  m.noalias() -= inverse_root_.transpose() * inverse_root_;
  m.noalias() += weights_ * weights_.transpose();  // αα' − Q
  const VectorXd per_length2 = (-2 * shape_.log_length).array().exp();
  slope->setZero(p + 2);
  for (Index i = 0; i < n; ++i) {
    (*slope)[p] += 0.5 * m(i, i) * variance_;
    for (Index j = 0; j < i; ++j) {
      const VectorXd d2 = (sample_.input.col(i) - sample_.input.col(j)).array().square() * per_length2.array();
      const Correlation c = correlation(shape_.kernel, d2.sum());
      (*slope)[p] += m(i, j) * variance_ * c.value;
      slope->head(p) -= (2 * m(i, j) * variance_ * c.slope) * d2;
    }
  }
  for (Index k = 0; k < p; ++k) (*slope)[k] += kLength.slope(shape_.log_length[k]);
  (*slope)[p] += kVariance.slope(shape_.log_variance);
  (*slope)[p + 1] = 0.5 * m.trace() * std::exp(shape_.log_nugget) + nugget.slope(shape_.log_nugget);
  return value;
}

}  // namespace millscope::emulate
