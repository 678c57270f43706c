#include "studies/emulate/sequential.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "kernel/base/random.hpp"
#include "studies/emulate/cma_es.hpp"
#include "studies/emulate/likelihood.hpp"
#include "studies/emulate/prior.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Score = std::function<double(const VectorXd& point)>;  // to be large

constexpr Index kDraws = 128;            // of the observables at a point
constexpr double kNoImprovement = 1e-3;  // of the objective's spread over the runs

/// Draws of the observables at a point, the same random numbers at every point:  f = m + √v ∘ (R^½ z). The nugget is left out: no search
/// can profit from what is not reproduced.
class Draws {
 public:
  Draws(const Emulator& emulator, const Objective& objective, std::uint64_t seed) : emulator_(emulator), objective_(objective) {
    base::RandomStream random(seed, 0xd4a);
    const Index q = emulator.observables();
    const MatrixXd root = Eigen::LLT<MatrixXd>(emulator.correlation() + 1e-12 * MatrixXd::Identity(q, q)).matrixL();
    correlated_.resize(q, kDraws);
    for (Index s = 0; s < kDraws; s += 2) {
      correlated_.col(s) = root * random.normals(q);
      correlated_.col(s + 1) = -correlated_.col(s);  // in pairs: the mean is exact
    }
  }

  VectorXd at(const VectorXd& point) const {
    const Prediction p = emulator_.at(point);
    const VectorXd deviation = p.variance.cwiseSqrt();
    VectorXd values(kDraws);
    for (Index s = 0; s < kDraws; ++s) values[s] = objective_(p.mean + deviation.cwiseProduct(correlated_.col(s)));
    if (!values.allFinite()) throw std::domain_error("the objective of emulated observables is not finite");
    return values;
  }
  const Emulator& emulator() const { return emulator_; }

 private:
  const Emulator& emulator_;
  const Objective& objective_;
  MatrixXd correlated_;
};

double deviation_of(const VectorXd& values) { return std::sqrt((values.array() - values.mean()).square().mean()); }

/// The runs that lie in this box, and their expected objectives.
struct Runs {
  std::vector<VectorXd> point;
  std::vector<double> expected;
  Index best = 0;

  Runs(const Draws& draws, const Box& box) {
    const MatrixXd& input = draws.emulator().training().input;
    for (Index i = 0; i < input.rows(); ++i) {
      const VectorXd x = input.row(i).transpose();
      if (!box.contains(x)) continue;
      point.push_back(x);
      expected.push_back(draws.at(x).mean());
      if (expected.back() < expected[best]) best = static_cast<Index>(expected.size()) - 1;
    }
  }
  /// The smallest expected objective; where no run lies in the box, there is nothing to improve on but the worst imaginable.
  double least() const { return expected.empty() ? std::numeric_limits<double>::max() : expected[best]; }
  double spread() const {
    if (expected.size() < 2) return 0;
    return deviation_of(VectorXd::Map(expected.data(), static_cast<Index>(expected.size())));
  }
};

/// Even over the box, and thicker about the best run.
std::vector<VectorXd> candidates(const Box& box, const Runs& runs, std::uint64_t seed) {
  constexpr int kEven = 300, kNear = 60;
  const MatrixXd even = prior_points(box, kEven * static_cast<int>(box.size()), seed);
  std::vector<VectorXd> points;
  for (Index i = 0; i < even.cols(); ++i) points.emplace_back(even.col(i));
  if (runs.point.empty()) return points;
  const VectorXd& best = runs.point[runs.best];
  points.push_back(best);
  base::RandomStream random(seed, 0x4ea);
  for (const double width : {0.3, 0.1, 0.03}) {
    for (int i = 0; i < kNear; ++i) {
      const VectorXd near = box.natural((box.coded(best) + width * random.normals(box.size())).cwiseMax(-1).cwiseMin(1));
      if (box.contains(near)) points.push_back(near);
    }
  }
  return points;
}

struct Best {
  VectorXd point;
  double score;
};

/// The best of the candidates, and of short climbs from the three best.
Best search(const Box& box, const std::vector<VectorXd>& points, const Score& score, std::uint64_t seed) {
  constexpr std::size_t kClimbs = 3;
  constexpr int kGenerations = 30;
  std::vector<double> value;
  for (const VectorXd& x : points) value.push_back(score(x));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] > value[b]; });
  Best best{points[order.front()], value[order.front()]};
  for (std::size_t start = 0; start < std::min(kClimbs, order.size()); ++start) {
    CmaEs climb(box, points[order[start]], 0.05, seed + start);
    while (climb.generation() < kGenerations * static_cast<int>(1 + box.size() / 4) && climb.finished().empty()) {
      std::vector<double> values;
      for (const VectorXd& x : climb.ask()) values.push_back(-score(x));
      climb.tell(values);
    }
    if (-climb.best_value() > best.score) best = {climb.best(), -climb.best_value()};
  }
  return best;
}

double improvement(const VectorXd& values, double least) { return (least - values.array()).cwiseMax(0).mean(); }

}  // namespace

Objective misfit_objective(const Emulator& emulator, const Observed& observed) {
  check_observed(emulator, observed);
  const VectorXd middle = emulator.box().natural(VectorXd::Zero(emulator.box().size()));
  const Prediction p = emulator.at(middle);
  const Eigen::LLT<MatrixXd> root(observed.covariance + MatrixXd((p.noise + p.nugget).asDiagonal()));
  return [root, value = observed.value](const VectorXd& observables) { return root.matrixL().solve(value - observables).squaredNorm(); };
}

VectorXd next_point(const Emulator& emulator, const Box& box, const Objective& objective, std::uint64_t seed) {
  box.check();
  const Draws draws(emulator, objective, seed);
  const Runs runs(draws, box);
  const std::vector<VectorXd> points = candidates(box, runs, seed);
  if (runs.point.empty()) return minimise(emulator, box, objective, seed).point;
  const double least = runs.least();
  const Best best = search(
      box, points, [&](const VectorXd& x) { return improvement(draws.at(x), least); }, seed);
  if (best.score > kNoImprovement * runs.spread()) return best.point;
  const Score unknown = [&](const VectorXd& x) {
    const VectorXd values = draws.at(x);
    const double deviation = deviation_of(values);
    return values.mean() - 3 * deviation <= least ? deviation : -values.mean();
  };
  return search(box, points, unknown, seed).point;
}

VectorXd next_point(const Emulator& emulator, const Box& box, const Observed& observed, std::uint64_t seed) {
  return next_point(emulator, box, misfit_objective(emulator, observed), seed);
}

std::vector<VectorXd> next_points(const Emulator& emulator, const Box& box, const Objective& objective, int count, std::uint64_t seed) {
  constexpr double kApart = 0.04;  // coded: a fiftieth of the ranges
  std::vector<VectorXd> points;
  Box apart = box;
  apart.allowed = [&](const VectorXd& x) {
    const VectorXd coded = box.coded(x);
    return (!box.allowed || box.allowed(x)) &&
           std::all_of(points.begin(), points.end(), [&](const VectorXd& y) { return (coded - box.coded(y)).norm() >= kApart; });
  };
  Emulator believed = emulator;
  for (int i = 0; i < count; ++i) {
    if (i > 0) believed = believed.believing(points.back());
    const std::uint64_t own = seed + static_cast<std::uint64_t>(i);
    points.push_back(next_point(believed, i > 0 ? apart : box, objective, own));
  }
  return points;
}

double expected_improvement(const Emulator& emulator, const Box& box, const Objective& objective, const VectorXd& point,
                            std::uint64_t seed) {
  if (!box.contains(point)) return 0;
  const Draws draws(emulator, objective, seed);
  return improvement(draws.at(point), Runs(draws, box).least());
}

Optimum minimise(const Emulator& emulator, const Box& box, const Objective& objective, std::uint64_t seed) {
  box.check();
  const Draws draws(emulator, objective, seed);
  const Runs runs(draws, box);
  const Best best = search(
      box, candidates(box, runs, seed), [&](const VectorXd& x) { return -draws.at(x).mean(); }, seed);
  return {best.point, -best.score, deviation_of(draws.at(best.point))};
}

double implausibility(const Emulator& emulator, const Observed& observed, const VectorXd& point) {
  check_observed(emulator, observed);
  const Prediction p = emulator.at(point);
  const Eigen::LLT<MatrixXd> root(observed.covariance + emulator.covariance(p));
  return std::sqrt(root.matrixL().solve(observed.value - p.mean).squaredNorm() / static_cast<double>(observed.value.size()));
}

}  // namespace millscope::emulate
