#include "studies/analysis/covariance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace millscope::analysis {
namespace {

/// Draws of one value, centred; empty where one of them is undefined.
std::vector<double> centred_draws(const ResultArray& array, std::size_t element, std::size_t draws) {
  std::vector<double> column(draws);
  double mean = 0;
  for (std::size_t b = 0; b < draws; ++b) {
    column[b] = array.draws[b * array.size() + element];
    mean += column[b];
  }
  if (!std::isfinite(mean)) return {};
  for (double& value : column) value -= mean / static_cast<double>(draws);
  return column;
}

/// Rank of the standardised draws: eigenvalues of the draws' Gram matrix above 1e-9 of the largest.
std::uint32_t rank_of(Eigen::MatrixXd deviations) {
  for (Eigen::Index j = 0; j < deviations.cols(); ++j) {
    const double norm = deviations.col(j).norm();
    if (norm > 0) deviations.col(j) /= norm;
  }
  const bool tall = deviations.rows() > deviations.cols();
  const Eigen::MatrixXd gram =
      tall ? Eigen::MatrixXd(deviations.transpose() * deviations) : Eigen::MatrixXd(deviations * deviations.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().maxCoeff();
  return largest > 0 ? static_cast<std::uint32_t>((solver.eigenvalues().array() > 1e-9 * largest).count()) : 0;
}

}  // namespace

void add_covariance(ResultSet& results) {
  const std::size_t draws = results.meta.draws;
  if (draws < 2 || results.meta.blocks.size() < 2) return;
  std::vector<std::vector<double>> columns;
  for (std::size_t a = 0; a < results.arrays.size(); ++a) {
    const ResultArray& array = results.arrays[a];
    if (array.is_axis || array.draws.empty() || array.shape.size() > 1 || array.size() > kLongestCovarianceRow) continue;
    for (std::size_t i = 0; i < array.size(); ++i) {
      if (!std::isfinite(array.sem[i])) continue;
      std::vector<double> column = centred_draws(array, i, draws);
      if (column.empty()) continue;
      columns.push_back(std::move(column));
      results.covariance_entries.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(i)});
    }
  }
  const auto size = static_cast<Eigen::Index>(columns.size());
  if (size == 0) return;
  Eigen::MatrixXd deviations(static_cast<Eigen::Index>(draws), size);
  for (Eigen::Index j = 0; j < size; ++j) {
    deviations.col(j) = Eigen::Map<const Eigen::VectorXd>(columns[j].data(), static_cast<Eigen::Index>(draws));
  }
  const Eigen::MatrixXd covariance = deviations.transpose() * deviations / static_cast<double>(draws - 1);
  results.covariance.assign(covariance.data(), covariance.data() + covariance.size());  // symmetric: the order does not matter
  results.covariance_rank = rank_of(std::move(deviations));
}

}  // namespace millscope::analysis
