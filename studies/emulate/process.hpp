// One observable as a Gaussian process over coded parameters u, in units of its own spread:
//
//   y_i = h(u_i)'β + Z(u_i) + e_i,   cov Z = s² k(r),  r² = Σ_k ((u_k − v_k)/l_k)²,   var e_i = n_i + g
//   A = K + diag(n) + g I,   Q = A⁻¹ − A⁻¹H (H'A⁻¹H)⁻¹ H'A⁻¹,   α = Q y
//   log restricted likelihood   −½ (log |A| + log |H'A⁻¹H| + y'Qy),  slope in a parameter   ½ (α' dA α − tr(Q dA))
//   prediction                  h'β + k'A⁻¹(y − Hβ),  variance   s² − k'A⁻¹k + t'(H'A⁻¹H)⁻¹t,  t = h − H'A⁻¹k
//   run i left out              y_i − prediction = α_i/Q_ii,  variance   1/Q_ii
//
// Rasmussen & Williams 2006, chapters 2 and 5; Dubrule 1983. Own, because the known noise of every run, the restricted likelihood and the
// left-out runs are what the honesty of the result hangs on: OpenTURNS' kriging has one noise for all, no closed leave-one-out, and 21
// packages.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "studies/emulate/emulator.hpp"

namespace millscope::emulate {

/// Terms of the trend at a coded point.
Eigen::VectorXd trend_terms(Trend trend, const Eigen::VectorXd& coded);
Eigen::Index trend_size(Trend trend, Eigen::Index parameters);

/// What belongs to one observable of the training, scaled.
struct Sample {
  Eigen::MatrixXd input;   ///< parameters × runs, coded
  Eigen::VectorXd output;  ///< in units of its spread, about its mean
  Eigen::VectorXd noise;   ///< variances, same unit squared
};

/// Hyper-parameters as they are searched.
struct Shape {
  Kernel kernel = Kernel::matern52;
  Trend trend = Trend::linear;
  Eigen::VectorXd log_length;
  double log_variance = 0, log_nugget = 0;
};

class Process {
 public:
  struct Value {
    double mean, variance;
  };
  struct LeftOut {
    Eigen::VectorXd residual, variance;
    double log_density() const;  ///< sum of the left-out runs' log densities
  };

  Process(Sample sample, Shape shape);
  Value at(const Eigen::VectorXd& coded) const;
  LeftOut leave_one_out() const;
  /// Penalised; `slope` (may be null): to log length…, log variance, log nugget.
  double log_likelihood(Eigen::VectorXd* slope) const;
  const Shape& shape() const { return shape_; }
  const Sample& sample() const { return sample_; }

 private:
  Eigen::VectorXd correlations(const Eigen::VectorXd& scaled) const;
  Sample sample_;
  Shape shape_;
  double variance_ = 1;            // s²
  Eigen::VectorXd per_length_;     // 1/l
  Eigen::MatrixXd scaled_;         // inputs in lengths
  Eigen::MatrixXd inverse_root_;   // L⁻¹ of A = L L'
  Eigen::MatrixXd trend_root_;     // L⁻¹ H
  Eigen::MatrixXd trend_inverse_;  // (H'A⁻¹H)⁻¹
  Eigen::VectorXd beta_, weights_;
  double log_determinants_ = 0;
};

/// The most likely process of this trend; several starts, of which the best is kept.
Process fit_process(const Sample& sample, Trend trend, const FitOptions& options, std::uint64_t stream);

}  // namespace millscope::emulate
