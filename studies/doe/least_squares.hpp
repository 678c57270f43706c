// Least squares with what a plan of runs asks of it: named terms, refusals, tests, residuals. For the files of this room.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "studies/doe/doe.hpp"

namespace millscope::doe {

/// Throws base::UserError for factors without a name, named twice or without a step.
void check(const std::vector<Factor>& factors);

/// Throws base::UserError unless there is one finite response a run, finite coded values, every factor varies and no two vary together.
void check(const Design& design, const Eigen::VectorXd& response);

/// y = X b + e.
struct LeastSquares {
  Eigen::MatrixXd model;               ///< X, [runs, terms]
  Eigen::MatrixXd inverse;             ///< (XᵀX)⁻¹
  Eigen::VectorXd coefficient, error;  ///< b, y − X b
  double residual_sum = 0;
  int df = 0;  ///< runs less terms
  double variance() const { return df > 0 ? residual_sum / df : kUndefined; }
};

/// Throws base::UserError when a term is a combination of others on these runs; `names`: of the terms, for the message.
LeastSquares solve(const Eigen::MatrixXd& model, const Eigen::VectorXd& response, const std::vector<std::string>& names);

/// What each term adds to those before it.
Eigen::VectorXd sequential_sums(const Eigen::MatrixXd& model, const Eigen::VectorXd& response);

/// What the residual grows by without a term: b²/(XᵀX)⁻¹.
double partial_sum(const LeastSquares& fit, Eigen::Index term);

/// Sets F and p of `line` against the mean square of `against`; nothing where that has no degrees of freedom.
void test(SumOfSquares& line, const SumOfSquares& against);

struct PureError {
  SumOfSquares pure, lack_of_fit;
  bool copies = false;  ///< replicates agree to the last digit: no error was measured
};

/// Splits the residual by runs that repeat each other; lack of fit is tested against pure error.
PureError split_residual(const Eigen::MatrixXd& coded, const Eigen::VectorXd& response, const LeastSquares& fit);

std::vector<Residual> residuals_of(const LeastSquares& fit);

/// P(|t| > value), and the value that |t| exceeds with probability `p`; P(F > value), and its quantile.
double t_beyond(double value, int df);
double t_quantile(double p, int df);
double f_beyond(double value, int df, int against);
double f_quantile(double p, int df, int against);

}  // namespace millscope::doe
