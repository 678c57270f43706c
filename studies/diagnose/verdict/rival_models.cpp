#include "studies/diagnose/verdict/rival_models.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/base/random.hpp"
#include "studies/doe/doe.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kPlacebos = 20;
constexpr int kTries = 4096;
constexpr double kPull = 0.05;  // towards the middle of the ranges, where powers leave θ open

/// Of these an observable of the same name is the same in all conditions: regions of the mill, readings of the camera's frame. Groups of
/// bins are only in their order.
bool same_everywhere(calibrate::ObservableKind kind) {
  using enum calibrate::ObservableKind;
  return kind == occupancy || kind == region_speed || kind == frame;
}

}  // namespace

VectorXd retuned_to_power(const naming::BankData& data, const naming::Surrogate& surrogate, const VectorXd& observed,
                          const MatrixXd& covariance, const std::vector<Index>& powers) {
  std::vector<doe::Factor> factors;
  for (const naming::Coordinate& c : data.theta) factors.push_back({c.name, 0, 1, ""});
  const MatrixXd tries = doe::sobol(std::move(factors), kTries).coded;
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < tries.rows(); ++k) {
    VectorXd u = tries.row(k).transpose();
    double q = 0;
    for (Index i = 0; i < u.size(); ++i) {
      const naming::Coordinate& c = data.theta[i];
      if (c.nuisance())
        u[i] = c.coded(c.usual.value_or(c.prior_mean));
      else
        q += kPull * u[i] * u[i];
    }
    const VectorXd y = surrogate.at(u);
    for (const Index i : powers) q += std::pow(y[i] - observed[i], 2) / covariance(i, i);
    if (q < least) least = q, best = u;
  }
  return best;
}

RivalModels::RivalModels(const HeldOutRequest& request, std::size_t held, const naming::Surrogate& surrogate,
                         const naming::Surrogate& held_surrogate, VectorXd variance)
    : r_(request), held_(held), surrogate_(surrogate), held_surrogate_(held_surrogate), variance_(std::move(variance)) {}

std::optional<std::size_t> RivalModels::metered() const {
  for (const std::size_t c : r_.fit) {
    if (!powers_of(c).empty()) return c;
  }
  return std::nullopt;
}

std::vector<Index> RivalModels::powers_of(std::size_t condition) const {
  std::vector<Index> powers;
  Index at = 0;
  for (const std::size_t c : r_.fit) {
    for (const calibrate::Observable& o : r_.evidence.recorded[c].observables) {
      if (c == condition && o.kind == calibrate::ObservableKind::power) powers.push_back(at);
      ++at;
    }
  }
  return powers;
}

VectorXd RivalModels::power_only(std::size_t condition) const {
  VectorXd u = retuned_to_power(r_.problem.data, surrogate_, r_.problem.observed, r_.naming.covariance, powers_of(condition));
  // Where the camera stood is no part of the practice; the rival model gets what the refitted base makes of it.
  for (std::size_t i = 0; i < r_.question.nuisances.size(); ++i) {
    const std::size_t place = r_.question.study.parameters.size() + i;
    if (r_.question.nuisances[i].of_camera()) u[place] = r_.naming.base.coded[place];
  }
  return u;
}

std::optional<Index> RivalModels::partner(Index i, std::size_t fitted) const {
  const auto& own = r_.evidence.recorded[held_].observables;
  const auto& other = r_.evidence.recorded[fitted].observables;
  const calibrate::Observable& what = own[i];
  if (same_everywhere(what.kind)) {
    const auto same = std::find_if(other.begin(), other.end(), [&](const calibrate::Observable& o) { return o.name == what.name; });
    return same == other.end() ? std::nullopt : std::optional<Index>(same - other.begin());
  }
  Index place = 0;
  for (Index k = 0; k < i; ++k) place += own[k].kind == what.kind ? 1 : 0;
  for (Index k = 0; k < std::ssize(other); ++k) {
    if (other[k].kind == what.kind && place-- == 0) return k;
  }
  return std::nullopt;
}

VectorXd RivalModels::placebo() const {
  const Index n = r_.evidence.recorded[held_].value.size(), m = r_.problem.observed.size();
  const naming::Weighting weighting(r_.problem.covariance, surrogate_);
  const MatrixXd& whitening = weighting.whitener;
  VectorXd moved = VectorXd::Zero(n);
  double least = std::numeric_limits<double>::infinity();
  const auto is_fitted = [&](Index i) {
    return std::any_of(r_.fit.begin(), r_.fit.end(), [&](std::size_t c) { return partner(i, c).has_value(); });
  };
  for (int k = 0; k < kPlacebos; ++k) {
    base::RandomStream random(r_.seed, static_cast<std::uint64_t>(1000 + k));
    const VectorXd chance = random.normals(n);
    VectorXd held(n), fitted = VectorXd::Zero(m);
    for (Index i = 0; i < n; ++i)  // what is not fitted stays as it is
      held[i] = is_fitted(i) ? chance[i] * std::sqrt(variance_[i]) : 0;
    Index at = 0;
    for (const std::size_t c : r_.fit) {
      for (Index i = 0; i < n; ++i) {
        if (const auto p = partner(i, c)) fitted[at + *p] = chance[i] * std::sqrt(r_.naming.covariance(at + *p, at + *p));
      }
      at += r_.evidence.recorded[c].value.size();
    }
    // θ and the placebo's size in turn: the problem is nearly linear.
    const naming::Model model(r_.problem.data, surrogate_, weighting, {});
    const VectorXd v = whitening * fitted;
    double size = 0;
    naming::FitResult fit = r_.naming.base;
    for (int turn = 0; turn < 6; ++turn) {
      const VectorXd residual = whitening * (r_.problem.observed - surrogate_.at(fit.coded));
      size = v.squaredNorm() > 0 ? v.dot(residual) / v.squaredNorm() : 0;
      fit = model.fit(r_.problem.observed - size * fitted);
    }
    if (fit.q >= least) continue;
    least = fit.q;
    moved = held_surrogate_.at(fit.coded) - held_surrogate_.at(r_.naming.base.coded) + size * held;
  }
  return moved;
}

VectorXd RivalModels::discrepancy() const {
  const std::size_t conditions = r_.fit.size();
  VectorXd speed(conditions);
  for (std::size_t k = 0; k < conditions; ++k) speed[k] = r_.question.speed[r_.fit[k]];
  const double here = r_.question.speed[held_];
  const double range = std::max(1e-9, std::max(speed.maxCoeff(), here) - std::min(speed.minCoeff(), here));
  const auto kernel = [range](double a, double b) { return std::exp(-0.5 * std::pow((a - b) / range, 2)); };
  const VectorXd residual = r_.problem.observed - surrogate_.at(r_.naming.base.coded);
  VectorXd moved = VectorXd::Zero(r_.evidence.recorded[held_].value.size());
  for (Index i = 0; i < moved.size(); ++i) {
    VectorXd difference(speed.size()), noise(speed.size());
    Index at = 0;
    bool all = true;
    for (std::size_t k = 0; k < conditions; ++k) {
      const auto there = partner(i, r_.fit[k]);
      all = there.has_value();
      if (!all) break;
      difference[k] = residual[at + *there];
      noise[k] = r_.naming.covariance(at + *there, at + *there);
      at += r_.evidence.recorded[r_.fit[k]].value.size();
    }
    if (!all) continue;
    const double signal = std::max(0.0, (difference.cwiseAbs2() - noise).mean());  // what the residuals have beyond their noise
    if (signal == 0) continue;
    MatrixXd k = MatrixXd(noise.asDiagonal());
    VectorXd to(speed.size());
    for (Index a = 0; a < speed.size(); ++a) {
      to[a] = signal * kernel(here, speed[a]);
      for (Index b = 0; b < speed.size(); ++b) k(a, b) += signal * kernel(speed[a], speed[b]);
    }
    moved[i] = to.dot(k.ldlt().solve(difference));
  }
  return moved;
}

}  // namespace millscope::diagnose
