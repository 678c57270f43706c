#include <nlopt.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "studies/emulate/likelihood.hpp"
#include "studies/emulate/posterior.hpp"
#include "studies/emulate/prior.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPerSide = 12;
constexpr std::uint64_t kSeed = 20150101;
constexpr double kLoss90 = 1.3527717270;  // half of χ² with one degree of freedom at 90 %

/// −1 … mode … 1, dense about the mode, so that narrow and wide peaks are both resolved.
VectorXd grid_about(double mode) {
  VectorXd grid(2 * kPerSide + 1);
  for (int i = 0; i <= kPerSide; ++i) {
    const double part = std::pow(static_cast<double>(i) / kPerSide, 2.5);
    grid[kPerSide - i] = mode + part * (-1 - mode);
    grid[kPerSide + i] = mode + part * (1 - mode);
  }
  return grid;
}

/// Maximises over all parameters but one.
class Readjustment {
 public:
  Readjustment(const Likelihood& likelihood, Index held) : likelihood_(likelihood), held_(held) {}

  /// Improves `point`, whose held parameter stays; returns the log density there.
  double improve(VectorXd& point) {
    point_ = point;
    best_ = likelihood_.log_density(point);
    best_point_ = point;
    const auto others = static_cast<unsigned>(point.size() - 1);
    if (others > 0 && best_ > kNowhere) {
      const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(nlopt_create(NLOPT_LN_SBPLX, others), nlopt_destroy);
      nlopt_set_lower_bounds1(search.get(), -1);
      nlopt_set_upper_bounds1(search.get(), 1);
      nlopt_set_initial_step1(search.get(), 0.1);
      nlopt_set_max_objective(search.get(), &objective, this);
      nlopt_set_ftol_abs(search.get(), 1e-4);
      nlopt_set_xtol_abs1(search.get(), 1e-5);
      nlopt_set_maxeval(search.get(), 150 * static_cast<int>(others));
      VectorXd start = without_held(point);
      double value = 0;
      nlopt_optimize(search.get(), start.data(), &value);
    }
    point = best_point_;
    return best_;
  }

 private:
  VectorXd without_held(const VectorXd& point) const {
    VectorXd others(point.size() - 1);
    others << point.head(held_), point.tail(point.size() - held_ - 1);
    return others;
  }
  static double objective(unsigned, const double* others, double*, void* data) {
    auto& self = *static_cast<Readjustment*>(data);
    for (Index k = 0, at = 0; k < self.point_.size(); ++k) {
      if (k != self.held_) self.point_[k] = others[at++];
    }
    const double value = self.likelihood_.log_density(self.point_);
    if (value > self.best_) {
      self.best_ = value;
      self.best_point_ = self.point_;
    }
    return std::max(value, -1e100);
  }
  const Likelihood& likelihood_;
  Index held_;
  VectorXd point_, best_point_;
  double best_ = kNowhere;
};

/// Where the log density has lost 1.35 on the way from the middle of the grid: √(−2 Δ) is nearly straight, as for a normal distribution.
double crossing(const VectorXd& grid, const VectorXd& loss, int direction) {
  for (Index i = kPerSide; i + direction >= 0 && i + direction < grid.size(); i += direction) {
    const Index next = i + direction;
    if (loss[next] > -kLoss90) continue;
    const double here = std::sqrt(std::max(0.0, -loss[i])), there = std::sqrt(-loss[next]);
    const double part = std::isfinite(there) ? (std::sqrt(kLoss90) - here) / (there - here) : 1.0;
    return grid[i] + part * (grid[next] - grid[i]);
  }
  return direction < 0 ? grid[0] : grid[grid.size() - 1];
}

void set_sensitivity(Profile& profile, const MatrixXd& slopes, Index held) {
  const VectorXd own = slopes.col(held);
  VectorXd rest = own;
  if (slopes.cols() > 1) {
    MatrixXd others(slopes.rows(), slopes.cols() - 1);
    others << slopes.leftCols(held), slopes.rightCols(slopes.cols() - held - 1);
    rest -= others * others.completeOrthogonalDecomposition().solve(own);
  }
  profile.sensitivity_alone = own.norm();
  profile.sensitivity_readjusted = rest.norm();
  profile.concealed = own.norm() > 0 ? 1 - rest.norm() / own.norm() : 0;
}

}  // namespace

Profile profile(const Emulator& emulator, const Box& box, const Observed& observed, int parameter) {
  const Likelihood likelihood(emulator, box, observed);
  const Index p = box.size(), held = parameter;
  if (parameter < 0 || held >= p) throw std::invalid_argument("profile: no such parameter");
  VectorXd mode = find_mode(likelihood, kSeed);
  Readjustment readjust(likelihood, held);
  VectorXd grid = grid_about(mode[held]);
  const Index n = grid.size();
  VectorXd alone(n), readjusted = VectorXd::Constant(n, kNowhere);
  MatrixXd best = mode.replicate(1, n);
  best.row(held) = grid.transpose();
  for (Index i = 0; i < n; ++i) alone[i] = likelihood.log_density(best.col(i));

  const MatrixXd anywhere = prior_points(box, 400, kSeed);
  const auto try_from = [&](Index i, VectorXd from) {
    from[held] = grid[i];
    if (const double value = readjust.improve(from); value > readjusted[i]) {
      readjusted[i] = value;
      best.col(i) = from;
    }
  };
  const auto visit = [&](Index i, Index neighbour) {
    try_from(i, best.col(neighbour));
    for (Index k = 0; readjusted[i] == kNowhere && k < anywhere.cols(); ++k) try_from(i, box.coded(anywhere.col(k)));
  };
  visit(kPerSide, kPerSide);
  for (Index i = kPerSide + 1; i < n; ++i) visit(i, i - 1);  // outwards
  for (Index i = kPerSide; i-- > 0;) visit(i, i + 1);
  for (Index i = n - 1; i-- > 0;) visit(i, i + 1);  // and across, for valleys seen from the other side only
  for (Index i = 1; i < n; ++i) visit(i, i - 1);

  const double top = std::max(readjusted.maxCoeff(), alone[kPerSide]);
  Profile result{};
  const auto to_natural = [&](double u) { return 0.5 * (box.lower[held] + box.upper[held] + u * (box.upper[held] - box.lower[held])); };
  result.value = grid.unaryExpr(to_natural);
  result.alone = alone.array() - top;
  result.readjusted = readjusted.array() - top;
  result.others.resize(n, p);
  for (Index i = 0; i < n; ++i) result.others.row(i) = box.natural(best.col(i)).transpose();
  result.low_alone = to_natural(crossing(grid, result.alone, -1));
  result.high_alone = to_natural(crossing(grid, result.alone, 1));
  result.low_readjusted = to_natural(crossing(grid, result.readjusted, -1));
  result.high_readjusted = to_natural(crossing(grid, result.readjusted, 1));
  set_sensitivity(result, likelihood.whitened_slopes(mode), held);
  return result;
}

}  // namespace millscope::emulate
