#include "studies/camera/maximise.hpp"

#include <nlopt.h>

#include <Eigen/Dense>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace millscope::camera {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

struct Problem {
  const LogLikelihood& groups;
  const std::vector<FitParameter>& parameters;

  double operator()(const std::vector<double>& x) const {
    double value = sum(groups(x));
    for (std::size_t i = 0; i < x.size(); ++i) value -= 0.5 * std::pow((x[i] - parameters[i].prior) / parameters[i].deviation, 2);
    return std::isfinite(value) ? value : -1e300;
  }
};

double objective(unsigned count, const double* x, double*, void* data) {
  return (*static_cast<const Problem*>(data))(std::vector<double>(x, x + count));
}

/// A step in which the likelihood changes by an amount that rounding does not hide; away from the bounds.
double step_of(const FitParameter& p) { return 1e-3 * std::max(1e-3, std::min(1.0, p.high - p.low)); }

struct Derivatives {
  Eigen::MatrixXd curvature, scatter;
};

Derivatives derivatives(const LogLikelihood& groups, const std::vector<FitParameter>& parameters, const std::vector<double>& at) {
  const auto n = static_cast<Eigen::Index>(at.size());
  const auto moved = [&](Eigen::Index i, double a, Eigen::Index j, double b) {
    std::vector<double> x = at;
    x[i] += a * step_of(parameters[i]);
    x[j] += b * step_of(parameters[j]);
    return groups(x);
  };
  Derivatives d{Eigen::MatrixXd(n, n), Eigen::MatrixXd::Zero(n, n)};
  const std::vector<double> middle = groups(at);
  Eigen::MatrixXd gradient(static_cast<Eigen::Index>(middle.size()), n);
  std::vector<double> up(at.size()), down(at.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const double h = step_of(parameters[i]);
    const std::vector<double> high = moved(i, 1, i, 0), low = moved(i, -1, i, 0);
    for (std::size_t g = 0; g < middle.size(); ++g) gradient(static_cast<Eigen::Index>(g), i) = (high[g] - low[g]) / (2 * h);
    d.curvature(i, i) = (sum(high) - 2 * sum(middle) + sum(low)) / (h * h);
    for (Eigen::Index j = 0; j < i; ++j) {
      const double k = step_of(parameters[j]);
      const double mixed = sum(moved(i, 1, j, 1)) - sum(moved(i, 1, j, -1)) - sum(moved(i, -1, j, 1)) + sum(moved(i, -1, j, -1));
      d.curvature(i, j) = d.curvature(j, i) = mixed / (4 * h * k);
    }
  }
  d.scatter = gradient.transpose() * gradient;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double known = std::pow(parameters[i].deviation, -2);
    d.curvature(i, i) -= known;
    d.scatter(i, i) += known;
  }
  return d;
}

/// H⁻¹ G H⁻¹ over the directions in which the likelihood has a maximum; infinite variance elsewhere.
std::vector<std::vector<double>> sandwich(const Derivatives& d) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(-d.curvature);
  const Eigen::VectorXd& bend = solver.eigenvalues();
  const double least = 1e-9 * std::max(1.0, bend.cwiseAbs().maxCoeff());
  Eigen::VectorXd inverse = bend.unaryExpr([&](double b) { return b > least ? 1 / b : 0.0; });
  const Eigen::MatrixXd h = solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
  const Eigen::MatrixXd covariance = h * d.scatter * h;
  const Eigen::Index n = bend.size();
  std::vector<std::vector<double>> result(n, std::vector<double>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) result[i][j] = covariance(i, j);
    for (Eigen::Index k = 0; k < n; ++k) {
      if (bend[k] <= least && std::abs(solver.eigenvectors()(i, k)) > 0.1) result[i][i] = std::numeric_limits<double>::infinity();
    }
  }
  return result;
}

}  // namespace

double Fit::error(std::size_t i) const {
  assert(!covariance.empty());
  return std::sqrt(covariance[i][i]);
}

Fit likeliest(const LogLikelihood& groups, const std::vector<FitParameter>& parameters) {
  const auto n = static_cast<unsigned>(parameters.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(nlopt_create(NLOPT_LN_BOBYQA, n), nlopt_destroy);
  Fit fit;
  std::vector<double> low, high, step;
  for (const FitParameter& p : parameters) {
    fit.value.push_back(p.start);
    low.push_back(p.low);
    high.push_back(p.high);
    step.push_back(0.1 * std::min(1.0, p.high - p.low));
  }
  nlopt_set_lower_bounds(search.get(), low.data());
  nlopt_set_upper_bounds(search.get(), high.data());
  nlopt_set_initial_step(search.get(), step.data());
  Problem problem{groups, parameters};
  nlopt_set_max_objective(search.get(), objective, &problem);
  nlopt_set_xtol_abs1(search.get(), 1e-3);
  nlopt_set_maxeval(search.get(), 2000);
  nlopt_optimize(search.get(), fit.value.data(), &fit.log_likelihood);
  return fit;
}

Fit maximise(const LogLikelihood& groups, const std::vector<FitParameter>& parameters) {
  Fit fit = likeliest(groups, parameters);
  fit.covariance = sandwich(derivatives(groups, parameters, fit.value));
  return fit;
}

}  // namespace millscope::camera
