#include "studies/emulate/check_training.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "kernel/base/error.hpp"

namespace millscope::emulate {
namespace {

using base::UserError;
using Eigen::Index;

void check_numbers(const Box& box, const Training& t) {
  for (Index i = 0; i < t.input.rows(); ++i) {
    for (Index k = 0; k < t.input.cols(); ++k) {
      if (std::isfinite(t.input(i, k))) continue;
      throw UserError(
          fmt::format("run {} of the emulator's training: {} is {}; every parameter needs a number", i + 1, box.name_of(k), t.input(i, k)));
    }
    for (Index j = 0; j < t.output.cols(); ++j) {
      const std::string what = fmt::format("run {} of the emulator's training: {}", i + 1, observable_name(t, j));
      if (!std::isfinite(t.output(i, j))) {
        throw UserError(fmt::format("{} is {}; leave the run or the observable out", what, t.output(i, j)));
      }
      if (!(std::isfinite(t.noise_variance(i, j)) && t.noise_variance(i, j) >= 0)) {
        throw UserError(fmt::format("{} has the variance {}; it must be a number, zero or more", what, t.noise_variance(i, j)));
      }
    }
  }
}

void check_variety(const Box& box, const Training& t) {
  const Index n = t.input.rows(), p = t.input.cols();
  for (Index j = 0; j < t.output.cols(); ++j) {
    const double spread = t.output.col(j).maxCoeff() - t.output.col(j).minCoeff();
    if (spread > 1e-12 * t.output.col(j).cwiseAbs().maxCoeff()) continue;
    throw UserError(
        fmt::format("{} is {} in all {} runs: it cannot tell parameters apart; leave it out", observable_name(t, j), t.output(0, j), n));
  }
  Eigen::MatrixXd coded(n, p);
  for (Index i = 0; i < n; ++i) coded.row(i) = box.coded(t.input.row(i).transpose()).transpose();
  coded.rowwise() -= coded.colwise().mean().eval();
  for (Index k = 0; k < p; ++k) {
    if (coded.col(k).cwiseAbs().maxCoeff() > 1e-9) continue;
    throw UserError(
        fmt::format("{} is {} in all {} runs: its effect cannot be learnt; vary it or fix it", box.name_of(k), t.input(0, k), n));
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(coded);
  if (qr.rank() < p) {
    throw UserError(
        fmt::format("{} changes only together with other parameters in the {} runs: their effects cannot be told apart; add runs in which "
                    "it changes alone, or tie them",
                    box.name_of(qr.colsPermutation().indices()[qr.rank()]), n));
  }
}

}  // namespace

std::string observable_name(const Training& training, Index observable) {
  return observable < std::ssize(training.observable) ? training.observable[observable] : fmt::format("observable {}", observable + 1);
}

void check_training(const Box& box, const Training& t) {
  box.check();
  const Index n = t.input.rows(), p = box.size();
  if (t.input.cols() != p || t.output.rows() != n || t.noise_variance.rows() != n || t.noise_variance.cols() != t.output.cols()) {
    throw std::invalid_argument("Training: tables of different sizes");
  }
  if (t.output.cols() == 0) throw UserError("the emulator has no observable to learn: choose at least one");
  if (n < p + 3) {
    throw UserError(fmt::format("{} successful runs for {} parameters: an emulator needs at least {}; simulate more", n, p, p + 3));
  }
  check_numbers(box, t);
  check_variety(box, t);
}

}  // namespace millscope::emulate
