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

namespace millscope::diagnose {
namespace {

constexpr std::size_t kForSquare = 3;      // different shares
constexpr std::size_t kRunsForSquare = 6;  // fewer leave the far end of the range open
constexpr std::size_t kSpare = 2;          // runs beyond the coefficients of a candidate's block
constexpr double kMostLeverage = 0.95;
constexpr double kRounding = 1e-11;  // of a column's norm
constexpr double kLeastFreedom = 1;  // runs beyond the coefficients that they decide
constexpr int kRounds = 4;           // of weights and scatter

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

/// The scatter of each row's group over that of rows without a candidate. `group`: the candidate of each row, −1 without.
VectorXd of_rows(const std::vector<double>& scatter, const std::vector<int>& group) {
  VectorXd out(static_cast<Index>(group.size()));
  for (std::size_t r = 0; r < group.size(); ++r)
    out[static_cast<Index>(r)] = group[r] < 0 ? 1 : scatter[static_cast<std::size_t>(group[r])];
  return out;
}

/// Squared residuals of each group's rows over what they are on average when their scatter is 1, which is a row's 1 − h, summed over the
/// observables, each over its own of all rows. Rows without a candidate last; NaN: too few rows to tell.
VectorXd scatter_seen(const MatrixXd& x, const MatrixXd& y, const std::vector<int>& group, const VectorXd& scatter) {
  const Solution solution = solve(x, scatter.cwiseInverse());
  const MatrixXd square = (y - x * (solution.map * y)).cwiseAbs2();
  const VectorXd leverage = leverages(x, solution);
  const Index last = 1 + *std::max_element(group.begin(), group.end());
  MatrixXd sum = MatrixXd::Zero(last + 1, y.cols());
  VectorXd freedom = VectorXd::Zero(last + 1);
  for (Index r = 0; r < x.rows(); ++r) {
    const int candidate = group[static_cast<std::size_t>(r)];
    const Index k = candidate < 0 ? last : candidate;
    sum.row(k) += square.row(r), freedom[k] += 1 - leverage[r];
  }
  // What is left of rows that a surface follows exactly is rounding: by that nothing is measured.
  const VectorXd whole = square.transpose() * scatter.cwiseInverse(), exact = kRounding * kRounding * y.colwise().squaredNorm().transpose();
  const VectorXd each = (sum.row(last).transpose().array() > exact.array()).select(whole.cwiseInverse(), 0);
  return (freedom.array() >= kLeastFreedom).select((sum * each).cwiseQuotient(freedom), std::nan(""));
}

/// By how much more the rows of each candidate scatter about the surface than those without, at least 1. Residuals of rows weighed by their
/// scatter tell it; a few rounds from equal weights on settle it.
std::vector<double> scatter_of(const MatrixXd& x, const MatrixXd& y, const std::vector<int>& group, int candidates) {
  std::vector<double> out(static_cast<std::size_t>(candidates), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    const VectorXd seen = scatter_seen(x, y, group, of_rows(out, group));
    const Index last = seen.size() - 1;
    for (Index k = 0; k < last; ++k) {
      const double ratio = seen[k] / seen[last];
      out[static_cast<std::size_t>(k)] = ratio > 1 ? ratio : 1;  // 1, too, where it cannot be told
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
  for (Index i = 0; i < values.size(); ++i) out[i] = theta[static_cast<std::size_t>(i)].coded(values[i]);
  return out;
}

VectorXd BankData::natural(const VectorXd& values) const {
  VectorXd out(values.size());
  for (Index i = 0; i < values.size(); ++i) out[i] = theta[static_cast<std::size_t>(i)].natural(values[i]);
  return out;
}

bool BankData::usual(const BankRow& row) const {
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (theta[i].usual && row.theta[static_cast<Index>(i)] != *theta[i].usual) return false;
  }
  return true;
}

Features::Features(const BankData& data) {
  const auto d = static_cast<Index>(data.theta.size());
  const auto multiplied = [&](Index i, Index j) {
    const Coordinate &a = data.theta[static_cast<std::size_t>(i)], &b = data.theta[static_cast<std::size_t>(j)];
    if (a.products == Products::none || b.products == Products::none) return false;
    return (a.products == Products::all || !b.nuisance()) && (b.products == Products::all || !a.nuisance());
  };
  for (Index i = 0; i < d; ++i) {
    for (Index j = i; j < d; ++j) {
      if (i == j || multiplied(i, j)) products_.emplace_back(i, j);
    }
  }
  coordinates_ = d;
  base_size_ = 1 + d + static_cast<Index>(products_.size());
  size_ = base_size_;
  for (int j = 0; j < data.candidates; ++j) add_candidate(data, j);
}

/// Its runs decide which columns it has: first those of nuisances apart that some of them vary, then those of the parameters, all or none.
void Features::add_candidate(const BankData& data, int candidate) {
  std::set<double> shares;
  std::size_t runs = 0, alone = 0;                        // those with a nuisance apart repeat parameters and shares of those without
  std::vector<std::size_t> varied(data.theta.size(), 0);  // runs in which a nuisance apart has another value than usual
  for (const BankRow& row : data.rows) {
    const auto has = [&](const Effect& e) { return e.candidate == candidate; };
    const auto effect = std::find_if(row.effects.begin(), row.effects.end(), has);
    if (effect == row.effects.end()) continue;
    shares.insert(effect->share), ++runs;
    alone += data.usual(row) ? 1 : 0;
    for (std::size_t i = 0; i < varied.size(); ++i) {
      if (const auto& usual = data.theta[i].usual) varied[i] += row.theta[static_cast<Index>(i)] != *usual ? 1 : 0;
    }
  }
  const bool square = shares.size() >= kForSquare && alone >= kRunsForSquare;
  std::vector<Index> multiply, parameters;
  for (std::size_t i = 0; i < varied.size(); ++i) {
    if (varied[i] >= kLeastTogether) multiply.push_back(static_cast<Index>(i));
    if (!data.theta[i].nuisance()) parameters.push_back(static_cast<Index>(i));
  }
  if (alone >= 1 + (square ? 1 : 0) + parameters.size() + kSpare) multiply.insert(multiply.end(), parameters.begin(), parameters.end());
  first_.push_back(size_);
  count_.push_back(runs == 0 ? 0 : 1 + (square ? 1 : 0) + static_cast<Index>(multiply.size()));
  size_ += count_.back();
  square_.push_back(square);
  multiply_.push_back(std::move(multiply));
}

VectorXd Features::base(const VectorXd& u) const {
  VectorXd x(base_size_);
  Index k = 0;
  x[k++] = 1;
  for (Index i = 0; i < u.size(); ++i) x[k++] = u[i];
  for (const auto& [i, j] : products_) x[k++] = u[i] * u[j];
  return x;
}

VectorXd Features::block(int candidate, const VectorXd& u, double share) const {
  const auto j = static_cast<std::size_t>(candidate);
  VectorXd x(count_[j]);
  if (x.size() == 0) return x;
  Index k = 0;
  x[k++] = share;
  if (square_[j]) x[k++] = share * share;
  for (const Index i : multiply_[j]) x[k++] = share * u[i];
  return x;
}

VectorXd Features::all(const VectorXd& u, const std::vector<Effect>& effects) const {
  VectorXd x = VectorXd::Zero(size_);
  x.head(base_size_) = base(u);
  for (const Effect& e : effects) x.segment(first(e.candidate), count(e.candidate)) = block(e.candidate, u, e.share);
  return x;
}

std::vector<Index> Features::columns(const std::vector<int>& candidates) const {
  std::vector<Index> out(static_cast<std::size_t>(base_size_));
  std::iota(out.begin(), out.end(), 0);
  for (const int j : candidates) {
    for (Index k = 0; k < count(j); ++k) out.push_back(first(j) + k);
  }
  return out;
}

Surrogate::Surrogate(const BankData& data) : Surrogate(data, Features(data), std::vector<bool>(data.rows.size(), true)) {}

Surrogate::Surrogate(const BankData& data, Features features, const std::vector<bool>& used) : features_(std::move(features)) {
  const auto rows = static_cast<Index>(std::count(used.begin(), used.end(), true));
  const std::vector<std::vector<Index>> points = points_of(data, used);
  if (static_cast<Index>(points.size()) <= features_.size()) {
    throw base::UserError(
        fmt::format("the bank has finished runs at {} points, its model {} coefficients; extend the bank (bank.base, "
                    "bank.each){}{}",
                    points.size(), features_.size(), data.left_out.empty() ? "" : "; ", fmt::join(data.left_out, "; ")));
  }
  MatrixXd x(rows, features_.size()), y(rows, data.value.cols());
  std::vector<int> group;
  Index k = 0;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    if (!used[r]) continue;
    group.push_back(data.rows[r].effects.empty() ? -1 : data.rows[r].effects.front().candidate);
    x.row(k) = features_.all(data.coded(data.rows[r].theta), data.rows[r].effects).transpose();
    y.row(k++) = data.value.row(static_cast<Index>(r));
  }
  // Rows that scatter more weigh less: else what the surface cannot follow of a strong effect would pull the base its way, and a recording
  // without the effect would seem to have some of it.
  scatter_with_ = scatter_of(x, y, group, features_.candidates());
  const VectorXd scatter = of_rows(scatter_with_, group);
  const Solution solution = solve(x, scatter.cwiseInverse());
  coefficients_ = solution.map * y;
  coefficient_error_ = solution.map * scatter.asDiagonal() * solution.map.transpose();
  residual_ = y - x * coefficients_;
  for (Index i = 0; i < y.cols(); ++i) {  // what is left of an exact column is rounding, whose correlations mean nothing
    if (residual_.col(i).norm() < kRounding * y.col(i).norm()) residual_.col(i).setZero();
  }
  degrees_ = static_cast<Index>(points.size()) - solution.rank;
  const VectorXd leverage = leverages(x, solution);
  left_out_ = without_own(residual_, leverage);
  for (Index r = 0; r < rows; ++r) mean_leverage_ += group[static_cast<std::size_t>(r)] < 0 ? leverage[r] : 0;
  mean_leverage_ /= static_cast<double>(std::max<std::ptrdiff_t>(1, std::count(group.begin(), group.end(), -1)));
  keep_scatter(points, y, scatter);
}

VectorXd Surrogate::at(const VectorXd& coded, const std::vector<Effect>& effects) const {
  VectorXd y = coefficients_.topRows(features_.base_size()).transpose() * features_.base(coded);
  for (const Effect& e : effects) {
    const Index n = features_.count(e.candidate);
    if (n > 0) y += coefficients_.middleRows(features_.first(e.candidate), n).transpose() * features_.block(e.candidate, coded, e.share);
  }
  return y;
}

double Surrogate::leverage(const VectorXd& coded, const std::vector<Effect>& effects) const {
  const VectorXd x = features_.all(coded, effects);
  return x.dot(coefficient_error_ * x);
}

double Surrogate::leverage_of(const VectorXd& coded, const std::vector<Effect>& effects) const {
  const VectorXd x = features_.all(coded, effects) - features_.all(coded, {});
  return x.dot(coefficient_error_ * x);
}

void choose_scales(BankData& data) {
  const auto press = [&] {
    const Surrogate s(data);
    const MatrixXd centred = data.value.rowwise() - data.value.colwise().mean();
    double sum = 0;
    for (Index i = 0; i < centred.cols(); ++i) sum += s.left_out().col(i).squaredNorm() / std::max(1e-300, centred.col(i).squaredNorm());
    return sum;
  };
  for (Coordinate& c : data.theta) {
    if (c.nuisance() || !(c.low > 0) || c.high < kWideRange * c.low) continue;
    const double plain = press();
    c.logarithmic = true;
    if (press() > plain) c.logarithmic = false;
  }
}

}  // namespace millscope::diagnose
