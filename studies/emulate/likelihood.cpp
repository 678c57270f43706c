#include "studies/emulate/likelihood.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "studies/emulate/check_training.hpp"
#include "studies/emulate/cma_es.hpp"
#include "studies/emulate/prior.hpp"

namespace millscope::emulate {

using base::UserError;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of a covariance in units of its own standard deviations, so that watts and fractions weigh alike.
double least_eigenvalue(const MatrixXd& covariance) {
  const VectorXd unit = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(unit.asDiagonal() * covariance * unit.asDiagonal(), Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

void check_covariance(const Training& names, const MatrixXd& covariance) {
  for (Index j = 0; j < covariance.rows(); ++j) {
    if (!covariance.col(j).allFinite())
      throw UserError(fmt::format("covariance of the recording's {} is not finite", observable_name(names, j)));
    if (covariance(j, j) < 0) {
      throw UserError(
          fmt::format("the recording's {} has the variance {}; it must not be negative", observable_name(names, j), covariance(j, j)));
    }
  }
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-9 * covariance.cwiseAbs().maxCoeff()) {
    throw UserError("the recording's covariance is not symmetric");
  }
  if (least_eigenvalue(covariance) < -1e-8) {
    throw UserError("the recording's covariance has a negative direction: it is no covariance; too few blocks for so many observables?");
  }
}

}  // namespace

void check_observed(const Emulator& emulator, const Observed& observed) {
  const Index q = emulator.observables();
  if (observed.value.size() != q || observed.covariance.rows() != q || observed.covariance.cols() != q) {
    throw std::invalid_argument("Observed: another number of observables than the emulator");
  }
  for (Index j = 0; j < q; ++j) {
    if (std::isfinite(observed.value[j])) continue;
    throw UserError(fmt::format("the recording's {} is {}; leave it out", observable_name(emulator.training(), j), observed.value[j]));
  }
  check_covariance(emulator.training(), observed.covariance);
}

Likelihood::Likelihood(const Emulator& emulator, const Box& box, const Observed& observed)
    : emulator_(emulator), box_(box), observed_(observed) {
  box.check();
  if (box.size() != emulator.box().size()) throw std::invalid_argument("Likelihood: box and emulator differ in parameters");
  check_observed(emulator, observed);
  const Prediction middle = emulator.at(box.natural(VectorXd::Zero(box.size())));
  if (!(least_eigenvalue(observed.covariance + emulator.covariance(middle)) > 1e-12)) {
    throw UserError(
        "the covariance of recording and emulator is singular: some observables follow exactly from others (bins that add up to one?); "
        "leave one of them out");
  }
}

Likelihood::At Likelihood::at(const VectorXd& coded) const {
  const Prediction p = emulator_.at(box_.natural(coded));
  return {observed_.value - p.mean, Eigen::LLT<MatrixXd>(observed_.covariance + emulator_.covariance(p))};
}

double Likelihood::log_density(const VectorXd& coded) const {
  if (coded.cwiseAbs().maxCoeff() > 1 || (box_.allowed && !box_.allowed(box_.natural(coded)))) return kNowhere;
  const At here = at(coded);
  if (here.root.info() != Eigen::Success) return kNowhere;
  return -0.5 * here.root.matrixL().solve(here.residual).squaredNorm() - here.root.matrixLLT().diagonal().array().log().sum();
}

double Likelihood::misfit(const VectorXd& coded) const {
  const At here = at(coded);
  return here.root.matrixL().solve(here.residual).squaredNorm();
}

MatrixXd Likelihood::whitened_slopes(const VectorXd& coded) const {
  constexpr double kStep = 1e-3;
  MatrixXd slopes(observables(), coded.size());
  for (Index k = 0; k < coded.size(); ++k) {
    VectorXd up = coded, down = coded;
    up[k] = std::min(1.0, coded[k] + kStep);
    down[k] = std::max(-1.0, coded[k] - kStep);
    slopes.col(k) = (emulator_.at(box_.natural(up)).mean - emulator_.at(box_.natural(down)).mean) / (up[k] - down[k]);
  }
  return at(coded).root.matrixL().solve(slopes);
}

VectorXd climb(const Likelihood& likelihood, const VectorXd& coded, double step, std::uint64_t seed) {
  const Box& box = likelihood.box();
  CmaEs search(box, box.natural(coded), std::clamp(step, 1e-4, 0.3), seed);
  const int generations = 60 + 20 * static_cast<int>(coded.size());
  while (search.generation() < generations && search.sigma() > 1e-5 && search.finished().empty()) {
    std::vector<double> values;
    for (const VectorXd& point : search.ask()) values.push_back(-likelihood.log_density(box.coded(point).cwiseMax(-1).cwiseMin(1)));
    search.tell(values);
  }
  const VectorXd found = box.coded(search.best()).cwiseMax(-1).cwiseMin(1);
  return likelihood.log_density(found) > likelihood.log_density(coded) ? found : coded;
}

VectorXd find_mode(const Likelihood& likelihood, std::uint64_t seed) {
  constexpr int kPerParameter = 200, kStarts = 3;
  const Box& box = likelihood.box();
  const Index p = box.size();
  const MatrixXd points = prior_points(box, kPerParameter * static_cast<int>(p), seed);
  std::vector<double> value(points.cols());
  std::vector<Index> order(value.size());
  std::iota(order.begin(), order.end(), Index{0});
  for (const Index i : order) value[i] = likelihood.log_density(box.coded(points.col(i)));
  const auto better = [&](Index a, Index b) { return value[a] > value[b]; };
  std::stable_sort(order.begin(), order.end(), better);
  VectorXd best = box.coded(points.col(order.front()));
  double most = value[order.front()];
  for (std::uint64_t start = 0; start < kStarts; ++start) {
    const VectorXd from = box.coded(points.col(order[start]));
    const VectorXd found = climb(likelihood, from, 0.05, seed + start);
    if (const double reached = likelihood.log_density(found); reached > most) {
      most = reached;
      best = found;
    }
  }
  return best;
}

}  // namespace millscope::emulate
