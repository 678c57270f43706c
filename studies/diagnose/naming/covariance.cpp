#include "studies/diagnose/naming/covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"

namespace millscope::naming {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd covariance_of(const MatrixXd& draws) {
  const MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(std::max<Index>(1, draws.rows() - 1));
}

MatrixXd shrunk(MatrixXd c, double blocks) {
  const VectorXd deviation = c.diagonal().cwiseSqrt();
  double chance = 0, found = 0;
  for (Index i = 0; i < c.rows(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const double scale = deviation[i] * deviation[j];
      if (!(scale > 0)) continue;
      const double r = c(i, j) / scale;
      chance += std::pow(1 - r * r, 2) / std::max(1.0, blocks - 1);
      found += r * r;
    }
  }
  const double kept = found > 0 ? 1 - std::min(1.0, chance / found) : 0;
  for (Index i = 0; i < c.rows(); ++i) {
    for (Index j = 0; j < c.cols(); ++j) {
      if (i != j) c(i, j) *= kept;
    }
  }
  return c;
}

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

}  // namespace millscope::naming
