// How wrong the surrogate is: the runs' scatter about it, less what is chance of single runs.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/diagnose/naming/covariance.hpp"
#include "studies/diagnose/naming/surrogate.hpp"

namespace millscope::naming {

bool repeats(const BankRow& a, const BankRow& b) {
  return a.theta == b.theta && std::equal(a.active.begin(), a.active.end(), b.active.begin(), b.active.end(),
                                          [](const ActiveCandidate& e, const ActiveCandidate& f) {
                                            return e.candidate == f.candidate && e.strength == f.strength;
                                          });
}

std::vector<std::vector<Index>> points_of(const BankData& data, const std::vector<bool>& used) {
  std::vector<std::vector<Index>> points;
  std::vector<std::size_t> first;
  Index k = 0;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    if (!used[r]) continue;
    const auto same = std::find_if(first.begin(), first.end(), [&](std::size_t f) { return repeats(data.rows[f], data.rows[r]); });
    if (same == first.end())
      first.push_back(r), points.push_back({k});
    else
      points[same - first.begin()].push_back(k);
    ++k;
  }
  return points;
}

std::vector<bool> all_but(const BankData& data, std::size_t row) {
  std::vector<bool> used;
  for (const BankRow& other : data.rows) used.push_back(!repeats(other, data.rows[row]));
  return used;
}

/// Of k runs at one point: √k times their mean residual, whose variance is that of one run where nothing is left unfollowed, and more than
/// that where something is; and what they differ by. `more`: how much more each row scatters than rows without a candidate.
void Surrogate::keep_scatter(const std::vector<std::vector<Index>>& points, const MatrixXd& y, const VectorXd& more) {
  scatter_ = MatrixXd::Zero(std::ssize(points), y.cols());
  degrees_repeated_ = y.rows() - scatter_.rows();
  repeated_ = MatrixXd::Zero(y.rows(), y.cols());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto runs = static_cast<double>(points[p].size());
    Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(y.cols());
    for (const Index r : points[p]) mean += y.row(r) / runs, scatter_.row(p) += residual_.row(r) / std::sqrt(runs * more[r]);
    for (const Index r : points[p]) repeated_.row(r) = (y.row(r) - mean) / std::sqrt(more[r]);
  }
}

/// Correlations are shrunk in coordinates in which the recording's noise has none: a run's chance is correlated much as that is, so that
/// there is less to lose than between the observables themselves.
MatrixXd Surrogate::residual_covariance(const MatrixXd& recording) const {
  const auto degrees = static_cast<double>(std::max<Index>(1, degrees_));
  const MatrixXd l = factor(recording);
  // Rows scaled so that their mean square is the unbiased variance of one run.
  const MatrixXd scaled = scatter_ * std::sqrt(static_cast<double>(scatter_.rows()) / degrees);
  const MatrixXd independent = l.triangularView<Eigen::Lower>().solve(scaled.transpose()).transpose();
  MatrixXd out = l * shrunk(covariance_of(independent), degrees) * l.transpose();
  for (Index i = 0; i < out.rows(); ++i) {  // what has no scatter gets none of its neighbours'
    if (scatter_.col(i).isZero(0)) out.row(i).setZero(), out.col(i).setZero();
  }
  return out;
}

/// ρ̂ = tr P/tr S in noise units, with the covariance P of repeated runs. Its relative error is √(2/ν*), ν* = ν (tr S)²/tr S²: ν degrees of
/// freedom of each observable, and as many observables as their correlations leave independent.
double Surrogate::chance(const MatrixXd& recording) const {
  if (degrees_repeated_ == 0) return 0;
  const MatrixXd s = residual_covariance(recording), w = whitener(recording + s), white = w * s * w.transpose(),
                 chance = repeated_ * w.transpose();
  const auto low_end = [&](const MatrixXd& basis) {
    const MatrixXd all = basis.transpose() * white * basis;
    const double p = (chance * basis).squaredNorm() / static_cast<double>(degrees_repeated_), trace = all.trace();
    if (!(trace > 0)) return 0.0;
    const double degrees = static_cast<double>(degrees_repeated_) * trace * trace / all.squaredNorm();
    return p / trace / (1 + base::kNormal90 * std::sqrt(2 / degrees));
  };
  return std::min({1.0, low_end(MatrixXd::Identity(s.rows(), s.rows())), low_end(span(w))});
}

MatrixXd Surrogate::span(const MatrixXd& whitener) const {
  const VectorXd centre = VectorXd::Zero(features_.coordinates());
  std::vector<VectorXd> effects;
  for (Index i = 0; i < features_.coordinates(); ++i) effects.emplace_back(coefficients_.row(1 + i));
  for (Index j = 0; j < features_.candidates(); ++j) {
    for (const double end : {features_.ends(j).first, features_.ends(j).second}) {
      if (end != 0) effects.push_back(at(centre, {{j, end}}) - at(centre));
    }
  }
  for (const Index column : features_.product_columns()) effects.emplace_back(coefficients_.row(column));
  MatrixXd white(whitener.rows(), effects.size());
  for (std::size_t k = 0; k < effects.size(); ++k) white.col(k) = whitener * effects[k];
  Eigen::ColPivHouseholderQR<MatrixXd> directions(white);
  return directions.householderQ() * MatrixXd::Identity(white.rows(), directions.rank());
}

MatrixXd Surrogate::error_covariance(const MatrixXd& recording) const {
  return (1 - chance(recording) + mean_leverage_) * residual_covariance(recording);
}

MatrixXd Surrogate::error_covariance(const MatrixXd& recording, const VectorXd& coded, const std::vector<ActiveCandidate>& active) const {
  return ((1 - chance(recording)) * scatter_of(active) + leverage(coded, active)) * residual_covariance(recording);
}

MatrixXd left_out_deviations(const BankData& data, std::optional<Index> candidate) {
  const Features features(data);
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    if (data.rows[r].candidate() == candidate && data.rows[r].active.size() < 2) rows.push_back(r);
  }
  const std::vector<bool> all(data.rows.size(), true);
  if (std::ssize(points_of(data, all)) <= features.size() + 1) return {};
  MatrixXd out(std::ssize(rows), data.value.cols());
  base::for_each_item(rows.size(), base::worker_count(0, rows.size()), [&](std::size_t k, std::size_t) {
    const BankRow& row = data.rows[rows[k]];
    const Surrogate others(data, features, all_but(data, rows[k]));
    out.row(static_cast<Index>(k)) = data.value.row(static_cast<Index>(rows[k])) - others.at(data.coded(row.theta), row.active).transpose();
  });
  return out;
}

}  // namespace millscope::naming
