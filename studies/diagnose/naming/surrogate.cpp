#include "studies/diagnose/naming/surrogate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "kernel/base/error.hpp"
#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::naming {
namespace {

constexpr std::size_t kForSquare = 3;             // different strengths
constexpr std::size_t kRunsForSquare = 6;         // fewer leave the far end of the range open
constexpr int kLeastDegree = 2, kMostDegree = 4;  // in a strength: some effects begin slowly, rise, and flatten
constexpr std::size_t kRunsForDegree = 4;         // runs alone for each power, where there is a third or a fourth
constexpr Index kSparePoints = 3;                 // beyond all coefficients, so that each can be left out
constexpr std::size_t kSpare = 2;                 // runs beyond the coefficients of a candidate's block
constexpr double kMostLeverage = 0.95;
constexpr double kColumnRounding = 1e-11;  // of a column's norm
constexpr double kLeastFreedom = 1;        // runs beyond the coefficients that they decide
constexpr int kRounds = 4;                 // of weights and scatter

/// Coefficients are map · values of the rows.
struct Solution {
  MatrixXd map;
  Index rank = 0;
};

/// Least squares with a weight for each row.
Solution solve(const MatrixXd& x, const VectorXd& weight) {
  const VectorXd root = weight.cwiseSqrt();
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr(MatrixXd(root.asDiagonal() * x));
  return {qr.pseudoInverse() * root.asDiagonal(), qr.rank()};
}

/// What each row's own value does to its prediction.
VectorXd leverages(const MatrixXd& x, const Solution& solution) {
  VectorXd own(x.rows());
  for (Index r = 0; r < x.rows(); ++r) own[r] = x.row(r).dot(solution.map.col(r));
  return own;
}

/// Residuals, each as from a fit without its row.
MatrixXd without_own(MatrixXd residual, const VectorXd& leverage) {
  for (Index r = 0; r < residual.rows(); ++r) residual.row(r) /= 1 - std::min(kMostLeverage, leverage[r]);
  return residual;
}

/// Which rows scatter alike; nothing: without a candidate.
using Groups = std::vector<std::optional<Index>>;

/// The scatter of each row's group over that of rows without a candidate.
VectorXd of_rows(const std::vector<double>& scatter, const Groups& group) {
  VectorXd out(group.size());
  for (std::size_t r = 0; r < group.size(); ++r) out[r] = group[r] ? scatter[*group[r]] : 1;
  return out;
}

/// Squared residuals of each group's rows over what they are on average when their scatter is 1, which is a row's 1 − h, summed over the
/// observables, each over its own of all rows. Rows without a candidate last; NaN: too few rows to tell.
VectorXd scatter_seen(const MatrixXd& x, const MatrixXd& y, const Groups& group, const VectorXd& scatter, Index groups) {
  const Solution solution = solve(x, scatter.cwiseInverse());
  const MatrixXd square = (y - x * (solution.map * y)).cwiseAbs2();
  const VectorXd leverage = leverages(x, solution);
  const Index last = groups;
  MatrixXd sum = MatrixXd::Zero(last + 1, y.cols());
  VectorXd freedom = VectorXd::Zero(last + 1);
  for (Index r = 0; r < x.rows(); ++r) {
    const Index k = group[r].value_or(last);
    sum.row(k) += square.row(r), freedom[k] += 1 - leverage[r];
  }
  // What is left of rows that a surface follows exactly is rounding: by that nothing is measured.
  const VectorXd whole = square.transpose() * scatter.cwiseInverse(),
                 exact = kColumnRounding * kColumnRounding * y.colwise().squaredNorm().transpose();
  const VectorXd each = (sum.row(last).transpose().array() > exact.array()).select(whole.cwiseInverse(), 0);
  return (freedom.array() >= kLeastFreedom).select((sum * each).cwiseQuotient(freedom), std::nan(""));
}

/// By how much more the rows of each group scatter about the surface than those without, at least 1. Residuals of rows weighed by their
/// scatter tell it; a few rounds from equal weights on settle it.
std::vector<double> scatter_by_group(const MatrixXd& x, const MatrixXd& y, const Groups& group, Index groups) {
  std::vector<double> out(groups, 1.0);
  for (int round = 0; round < kRounds; ++round) {
    const VectorXd seen = scatter_seen(x, y, group, of_rows(out, group), groups);
    for (Index k = 0; k < groups; ++k) {
      const double ratio = seen[k] / seen[groups];
      out[k] = ratio > 1 ? ratio : 1;  // 1, too, where it cannot be told
    }
  }
  return out;
}

}  // namespace

double Coordinate::coded(double value) const {
  if (logarithmic) return 2 * std::log(value / low) / std::log(high / low) - 1;
  return 2 * (value - low) / (high - low) - 1;
}

double Coordinate::natural(double value) const {
  if (logarithmic) return low * std::pow(high / low, 0.5 * (value + 1));
  return low + 0.5 * (value + 1) * (high - low);
}

/// σ of a logarithm: to first order that of the value over its mean.
double Coordinate::prior_weight() const {
  if (!nuisance()) return 0;
  return logarithmic ? 0.5 * std::log(high / low) * prior_mean / prior_sigma : 0.5 * (high - low) / prior_sigma;
}

VectorXd BankData::coded(const VectorXd& values) const {
  VectorXd out(values.size());
  for (Index i = 0; i < values.size(); ++i) out[i] = theta[i].coded(values[i]);
  return out;
}

VectorXd BankData::natural(const VectorXd& values) const {
  VectorXd out(values.size());
  for (Index i = 0; i < values.size(); ++i) out[i] = theta[i].natural(values[i]);
  return out;
}

bool BankData::usual(const BankRow& row) const {
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (theta[i].usual && row.theta[i] != *theta[i].usual) return false;
  }
  return true;
}

Features::Features(const BankData& data) : coordinates_(std::ssize(data.theta)), candidates_(data.candidates) {
  const Index d = coordinates_;
  const auto multiplied = [&](Index i, Index j) {
    const Coordinate &a = data.theta[i], &b = data.theta[j];
    if (a.products == Products::none || b.products == Products::none) return false;
    return (a.products == Products::all || !b.nuisance()) && (b.products == Products::all || !a.nuisance());
  };
  products_.push_back({});
  for (Index i = 0; i < d; ++i) products_.push_back({0, factor_of_coordinate(i)});
  for (Index i = 0; i < d; ++i) {
    for (Index j = i; j < d; ++j) {
      if (i == j || multiplied(i, j)) products_.push_back({factor_of_coordinate(i), factor_of_coordinate(j)});
    }
  }
  base_size_ = size();
  for (Index j = 0; j < candidates_; ++j) add_candidate(data, j);
  add_both(data);
}

/// Its runs decide which columns it has: first those of nuisances that some of them vary apart, then those of the parameters, all or none.
void Features::add_candidate(const BankData& data, Index candidate) {
  std::set<double> strengths;
  std::size_t runs = 0, alone = 0;                  // those with a nuisance varied apart repeat parameters and strengths of those without
  std::vector<Index> varied(data.theta.size(), 0);  // runs in which a nuisance that is varied apart has another value than usual
  for (const BankRow& row : data.rows) {
    const auto has = [&](const ActiveCandidate& e) { return e.candidate == candidate; };
    const auto found = std::find_if(row.active.begin(), row.active.end(), has);
    if (found == row.active.end()) continue;
    strengths.insert(found->strength), ++runs;
    alone += data.usual(row) && row.active.size() == 1 ? 1 : 0;
    for (std::size_t i = 0; i < varied.size(); ++i) {
      if (const auto& usual = data.theta[i].usual) varied[i] += row.theta[i] != *usual ? 1 : 0;
    }
  }
  const int asked = data.degree.empty() ? kLeastDegree : data.degree[candidate];
  int degree = strengths.size() >= kForSquare && alone >= kRunsForSquare ? kLeastDegree : 1;
  while (degree < asked && strengths.size() > degree + 1U && alone >= kRunsForDegree * (degree + 1)) ++degree;
  std::vector<Index> multiply, parameters;
  for (Index i = 0; i < std::ssize(varied); ++i) {
    if (varied[i] >= kLeastTogether) multiply.push_back(i);
    if (!data.theta[i].nuisance()) parameters.push_back(i);
  }
  if (alone >= degree + parameters.size() + kSpare) multiply.insert(multiply.end(), parameters.begin(), parameters.end());
  strengths.insert(0);
  ends_.emplace_back(*strengths.begin(), *strengths.rbegin());
  first_.push_back(size());
  const Index strength = factor_of_strength(candidate), squared = factor_of_square(candidate);
  if (runs > 0) products_.push_back({0, strength});
  if (degree >= 2) products_.push_back({strength, strength});
  if (degree >= 3) products_.push_back({strength, squared});
  if (degree >= 4) products_.push_back({squared, squared});
  for (const Index i : multiply) products_.push_back({strength, factor_of_coordinate(i)});
  count_.push_back(size() - first_.back());
}

void Features::add_both(const BankData& data) {
  std::map<std::pair<Index, Index>, Index> runs;
  for (const BankRow& row : data.rows) {
    if (row.active.size() == 2) ++runs[std::minmax(row.active[0].candidate, row.active[1].candidate)];
  }
  for (const auto& [both, count] : runs) {
    if (count < kLeastTogether) continue;
    together_[both] = size();
    products_.push_back({factor_of_strength(both.first), factor_of_strength(both.second)});
  }
}

std::optional<Index> Features::product(Index a, Index b) const {
  const auto found = together_.find(std::minmax(a, b));
  return found == together_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Index> Features::group(const std::vector<ActiveCandidate>& active) const {
  if (active.size() == 1) return active[0].candidate;
  if (active.size() != 2) return {};
  const auto found = together_.find(std::minmax(active[0].candidate, active[1].candidate));
  if (found == together_.end()) return {};
  return candidates() + std::distance(together_.begin(), found);
}

std::vector<Index> Features::product_columns() const {
  std::vector<Index> out;
  for (const auto& [both, column] : together_) out.push_back(column);
  return out;
}

VectorXd Features::all(const VectorXd& u, const std::vector<ActiveCandidate>& active) const {
  VectorXd factor = VectorXd::Zero(factors()), x(size());
  factor[0] = 1;
  factor.segment(factor_of_coordinate(0), coordinates_) = u;
  for (const ActiveCandidate& e : active) {
    factor[factor_of_strength(e.candidate)] = e.strength;
    factor[factor_of_square(e.candidate)] = e.strength * e.strength;
  }
  for (Index k = 0; k < x.size(); ++k) x[k] = factor[products_[k].one] * factor[products_[k].other];
  return x;
}

std::vector<Index> Features::columns(const std::vector<Index>& candidates) const {
  std::vector<Index> out(base_size_);
  std::iota(out.begin(), out.end(), 0);
  for (const Index j : candidates) {
    for (Index k = 0; k < count(j); ++k) out.push_back(first(j) + k);
  }
  if (candidates.size() == 2) {
    if (const auto column = product(candidates[0], candidates[1])) out.push_back(*column);
  }
  return out;
}

Surrogate::Surrogate(const BankData& data) : Surrogate(data, Features(data), std::vector<bool>(data.rows.size(), true)) {}

Surrogate::Surrogate(const BankData& data, Features features, const std::vector<bool>& used) : features_(std::move(features)) {
  const Index rows = std::count(used.begin(), used.end(), true);
  const std::vector<std::vector<Index>> points = points_of(data, used);
  if (std::ssize(points) <= features_.size()) {
    throw base::UserError(
        fmt::format("the bank has finished runs at {} points, its model {} coefficients; extend the bank (bank.base, "
                    "bank.each){}{}",
                    points.size(), features_.size(), data.left_out.empty() ? "" : "; ", fmt::join(data.left_out, "; ")));
  }
  MatrixXd x(rows, features_.size()), y(rows, data.value.cols());
  Groups group;
  Index k = 0;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    if (!used[r]) continue;
    group.push_back(features_.group(data.rows[r].active));
    x.row(k) = features_.all(data.coded(data.rows[r].theta), data.rows[r].active).transpose();
    y.row(k++) = data.value.row(r);
  }
  // Rows that scatter more weigh less: else what the surface cannot follow of a strong effect would pull the base its way, and a recording
  // without the effect would seem to have some of it.
  scatter_with_ = scatter_by_group(x, y, group, features_.groups());
  const VectorXd scatter = of_rows(scatter_with_, group);
  const Solution solution = solve(x, scatter.cwiseInverse());
  coefficients_ = solution.map * y;
  coefficient_error_ = solution.map * scatter.asDiagonal() * solution.map.transpose();
  residual_ = y - x * coefficients_;
  for (Index i = 0; i < y.cols(); ++i) {  // what is left of an exact column is rounding, whose correlations mean nothing
    if (residual_.col(i).norm() < kColumnRounding * y.col(i).norm()) residual_.col(i).setZero();
  }
  degrees_ = std::ssize(points) - solution.rank;
  const VectorXd leverage = leverages(x, solution);
  left_out_ = without_own(residual_, leverage);
  for (Index r = 0; r < rows; ++r) mean_leverage_ += group[r] ? 0 : leverage[r];
  mean_leverage_ /= static_cast<double>(std::max<std::ptrdiff_t>(1, std::count(group.begin(), group.end(), std::nullopt)));
  keep_scatter(points, y, scatter);
}

VectorXd Surrogate::at(const VectorXd& coded, const std::vector<ActiveCandidate>& active) const {
  return coefficients_.transpose() * features_.all(coded, active);
}

double Surrogate::scatter_of(const std::vector<ActiveCandidate>& active) const {
  if (const auto group = features_.group(active)) return scatter_with_[*group];
  double out = 1;
  for (const ActiveCandidate& e : active) out += scatter_with_[e.candidate] - 1;
  return out;
}

double Surrogate::leverage(const VectorXd& coded, const std::vector<ActiveCandidate>& active) const {
  const VectorXd x = features_.all(coded, active);
  return x.dot(coefficient_error_ * x);
}

double Surrogate::leverage_of(const VectorXd& coded, const std::vector<ActiveCandidate>& active,
                              const std::vector<ActiveCandidate>& beside) const {
  const VectorXd x = features_.all(coded, active) - features_.all(coded, beside);
  return x.dot(coefficient_error_ * x);
}

void choose_terms(BankData& data, const MatrixXd& recording) {
  data.degree.assign(data.candidates, kLeastDegree);
  std::vector<Coordinate*> wide;
  for (Coordinate& c : data.theta) {
    if (c.nuisance() || !(c.low > 0) || c.high < kWideRange * c.low) continue;
    c.logarithmic = false;
    wide.push_back(&c);
  }
  const Surrogate plain(data);
  const MatrixXd white = whitener(recording + plain.residual_covariance(recording)), seen = white.transpose() * plain.span(white);
  VectorXd weight(std::ssize(data.rows));
  for (Index r = 0; r < weight.size(); ++r) weight[r] = 1 / std::sqrt(plain.scatter_of(data.rows[r].active));
  const auto press = [&](const Surrogate& s) { return (weight.asDiagonal() * s.left_out() * seen).squaredNorm(); };
  const Index points = std::ssize(points_of(data, std::vector<bool>(data.rows.size(), true)));
  double least = press(plain);
  const auto better = [&] {
    if (points < Features(data).size() + kSparePoints) return false;
    const double now = press(Surrogate(data));
    if (!(now < least - least / static_cast<double>(points))) return false;  // by more than one run is off on average
    least = now;
    return true;
  };
  for (Coordinate* c : wide) {
    c->logarithmic = true;
    c->logarithmic = better();
  }
  for (int& degree : data.degree) {
    int best = degree;
    for (degree = best + 1; degree <= kMostDegree; ++degree) {
      if (better()) best = degree;
    }
    degree = best;
  }
}

}  // namespace millscope::naming
