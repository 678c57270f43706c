#include "studies/emulate/cma_es.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/base/random.hpp"
#include "studies/emulate/cma_transform.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Hansen 2016, Table 1, without negative weights. `parents`: how many of the generation are recombined.
struct Strategy {
  VectorXd weights;
  double mu, c_sigma, damping, c_path, c_one, c_mu, expected_length;

  Strategy(double n, int population, Index parents) : weights(parents) {
    for (Index i = 0; i < parents; ++i) weights[i] = std::log(0.5 * (population + 1)) - std::log(static_cast<double>(i) + 1);
    weights = weights.cwiseMax(0);
    weights /= weights.sum();
    mu = 1 / weights.squaredNorm();
    c_sigma = (mu + 2) / (n + mu + 5);
    damping = 1 + 2 * std::max(0.0, std::sqrt((mu - 1) / (n + 1)) - 1) + c_sigma;
    c_path = (4 + mu / n) / (n + 4 + 2 * mu / n);
    c_one = 2 / ((n + 1.3) * (n + 1.3) + mu);
    c_mu = std::min(1 - c_one, 2 * (mu - 2 + 1 / mu) / ((n + 2) * (n + 2) + mu));
    expected_length = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }
};

VectorXd to_fraction(const Box& box, const VectorXd& point) { return (point - box.lower).cwiseQuotient(box.upper - box.lower); }

VectorXd to_natural(const Box& box, const VectorXd& inner) {
  const VectorXd fraction = inner.unaryExpr(&into_range);
  return (box.lower + fraction.cwiseProduct(box.upper - box.lower)).cwiseMax(box.lower).cwiseMin(box.upper);
}

std::size_t history_length(Index parameters, int population) {
  return static_cast<std::size_t>(10 + std::ceil(30.0 * static_cast<double>(parameters) / population));
}

}  // namespace

CmaEs::CmaEs(const Box& box, const VectorXd& start, double sigma, std::uint64_t seed, int population) : box_(box) {
  box.check();
  const Index n = box.size();
  if (start.size() != n) throw std::invalid_argument("CmaEs: start has another number of parameters");
  if (!box.contains(start)) throw base::UserError("the search's starting point lies outside the ranges or is not allowed; choose another");
  if (!(sigma > 0 && sigma <= 1))
    throw base::UserError(fmt::format("the search's first step is {}; it is a fraction of the ranges, above 0, up to 1", sigma));
  if (population != 0 && population < 4)
    throw base::UserError(fmt::format("a population of {} is too small for CMA-ES; take 4 or more", population));
  state_.mean = to_fraction(box, start).unaryExpr(&out_of_range);
  state_.path_sigma = state_.path_covariance = VectorXd::Zero(n);
  state_.covariance = MatrixXd::Identity(n, n);
  state_.best = start;
  state_.best_value = kInfinity;
  state_.sigma = sigma;
  state_.population = population != 0 ? population : 4 + static_cast<int>(3 * std::log(static_cast<double>(n)));
  state_.random = seed;
}

CmaEs::CmaEs(const Box& box, State state) : box_(box), state_(std::move(state)) {}

std::vector<VectorXd> CmaEs::ask() {
  constexpr int kTries = 100, kHalvings = 40;
  if (state_.asked.empty()) {
    base::RandomStream random(state_.random, static_cast<std::uint64_t>(state_.generation));
    const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(state_.covariance);
    const MatrixXd root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    const auto draw = [&]() -> VectorXd { return state_.mean + state_.sigma * (root * random.normals(box_.size())); };
    const VectorXd refuge = to_fraction(box_, state_.best).unaryExpr(&out_of_range);
    for (int i = 0; i < state_.population; ++i) {
      VectorXd inner = draw();
      for (int t = 0; t < kTries && !box_.contains(to_natural(box_, inner)); ++t) inner = draw();
      // Next to nothing around the middle is allowed: come closer to the best point, which is.
      for (int t = 0; t < kHalvings && !box_.contains(to_natural(box_, inner)); ++t) inner = 0.5 * (inner + refuge);
      state_.asked.push_back(box_.contains(to_natural(box_, inner)) ? inner : refuge);
    }
  }
  std::vector<VectorXd> points;
  for (const VectorXd& inner : state_.asked) points.push_back(to_natural(box_, inner));
  return points;
}

void CmaEs::tell(const std::vector<double>& values) {
  if (state_.asked.empty()) throw std::invalid_argument("CmaEs::tell: nothing was asked");
  if (values.size() != state_.asked.size()) throw std::invalid_argument("CmaEs::tell: one value for every point asked");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) || values[i] == -kInfinity)
      throw std::invalid_argument("CmaEs::tell: NaN or -infinity; a failed point is +infinity");
    if (std::isfinite(values[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  if (!order.empty() && values[order.front()] < state_.best_value) {
    state_.best_value = values[order.front()];
    state_.best = to_natural(box_, state_.asked[order.front()]);
  }
  state_.history.push_back(order.empty() ? kInfinity : values[order.front()]);
  if (state_.history.size() > history_length(box_.size(), state_.population)) state_.history.erase(state_.history.begin());
  if (order.empty()) {
    state_.sigma *= 0.7;  // all failed: stay nearer to where it is known to work
  } else {
    recombine(order);
  }
  state_.asked.clear();
  ++state_.generation;
}

void CmaEs::recombine(const std::vector<std::size_t>& order) {
  const Index n = box_.size();
  const Index parents = std::min<Index>(state_.population / 2, static_cast<Index>(order.size()));
  const Strategy s(static_cast<double>(n), state_.population, parents);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(state_.covariance);
  MatrixXd steps(n, parents);
  for (Index i = 0; i < parents; ++i) steps.col(i) = (state_.asked[order[i]] - state_.mean) / state_.sigma;
  const VectorXd step = steps * s.weights;
  state_.mean += state_.sigma * step;

  const VectorXd whitened =
      axes.eigenvectors() * (axes.eigenvectors().transpose() * step).cwiseQuotient(axes.eigenvalues().cwiseMax(1e-300).cwiseSqrt());
  state_.path_sigma = (1 - s.c_sigma) * state_.path_sigma + std::sqrt(s.c_sigma * (2 - s.c_sigma) * s.mu) * whitened;
  const double length = state_.path_sigma.norm();
  const double settled = std::sqrt(1 - std::pow(1 - s.c_sigma, 2 * (state_.generation + 1)));
  const bool path_counts = length / settled < (1.4 + 2 / (static_cast<double>(n) + 1)) * s.expected_length;
  state_.path_covariance = (1 - s.c_path) * state_.path_covariance;
  if (path_counts) state_.path_covariance += std::sqrt(s.c_path * (2 - s.c_path) * s.mu) * step;

  const double lost = path_counts ? 0 : s.c_one * s.c_path * (2 - s.c_path);
  state_.covariance = (1 + lost - s.c_one - s.c_mu) * state_.covariance +
                      s.c_one * state_.path_covariance * state_.path_covariance.transpose() +
                      s.c_mu * steps * s.weights.asDiagonal() * steps.transpose();
  // A step beyond the whole range means nothing here.
  state_.sigma = std::min(1.0, state_.sigma * std::exp(std::min(1.0, s.c_sigma / s.damping * (length / s.expected_length - 1))));
}

const VectorXd& CmaEs::best() const { return state_.best; }
double CmaEs::best_value() const { return state_.best_value; }
VectorXd CmaEs::mean() const { return to_natural(box_, state_.mean); }
int CmaEs::generation() const { return state_.generation; }
double CmaEs::sigma() const { return state_.sigma; }

std::string CmaEs::finished() const {
  const double step = state_.sigma * std::sqrt(state_.covariance.diagonal().maxCoeff());
  if (step < 1e-6) return "the steps are below a millionth of the ranges";
  const VectorXd axes = Eigen::SelfAdjointEigenSolver<MatrixXd>(state_.covariance, Eigen::EigenvaluesOnly).eigenvalues();
  if (axes.maxCoeff() > 1e14 * axes.minCoeff())
    return "the distribution of the steps is flat: some parameters have no effect beside others";
  if (state_.history.size() < history_length(box_.size(), state_.population)) return {};
  const auto [least, most] = std::minmax_element(state_.history.begin(), state_.history.end());
  if (*least == kInfinity) return "all points have failed for many generations";
  if (*most - *least <= 1e-12 * std::max(1e-300, std::abs(*least))) return "the best values do not change any more";
  return {};
}

}  // namespace millscope::emulate
