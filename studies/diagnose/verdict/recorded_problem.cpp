#include "studies/diagnose/verdict/recorded_problem.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/calibrate/power.hpp"
#include "studies/diagnose/naming/surrogate.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kSurely = 3.1;     // standard errors: by chance so far below in one of a thousand
constexpr double kSmallest = 1e-6;  // of a variance, left of sums that are always the same: one number that is compared twice

/// Of the variances of two covariances the median ratio, where both have some.
double median_ratio(const MatrixXd& own, const MatrixXd& other) {
  std::vector<double> ratios;
  for (Index i = 0; i < own.rows(); ++i) {
    if (own(i, i) > 0 && other(i, i) > 0) ratios.push_back(own(i, i) / other(i, i));
  }
  return ratios.empty() ? 0 : base::quantile(ratios, 0.5);
}

/// What resampling says of a condition's simulations without a candidate, each as large as the recording's own, on average. Empty where
/// there is none.
MatrixXd by_simulations(const MatrixXd& own, const Bank& bank, std::size_t condition) {
  const std::optional<std::size_t> k = bank.place_of(condition);
  MatrixXd sum;
  double runs = 0;
  for (std::size_t p = 0; k && p < bank.points.size(); ++p) {
    const auto& seen = bank.seen[p][*k];
    if (!seen || !bank.points[p].active.empty() || seen->resampled.rows() != own.rows()) continue;
    const double ratio = median_ratio(own, seen->resampled);
    if (!(ratio > 0)) continue;
    if (sum.size() == 0) sum = MatrixXd::Zero(own.rows(), own.cols());
    sum += ratio * seen->resampled, ++runs;
  }
  return sum / runs;
}

/// The same, in each of its own directions at least `part` of what the recording has there.
MatrixXd raised(const MatrixXd& simulated, const MatrixXd& own, double part) {
  const VectorXd variance = simulated.diagonal().cwiseMax(own.diagonal());
  std::vector<Index> some;
  for (Index i = 0; i < variance.size(); ++i) {
    if (variance[i] > 0) some.push_back(i);
  }
  const VectorXd unit = variance(some).cwiseSqrt(), per_unit = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(per_unit.asDiagonal() * simulated(some, some) * per_unit.asDiagonal());
  const MatrixXd directions = unit.asDiagonal() * solver.eigenvectors(), across = per_unit.asDiagonal() * solver.eigenvectors();
  const VectorXd recorded = (across.transpose() * own(some, some) * across).diagonal();
  const VectorXd along = solver.eigenvalues().cwiseMax(part * recorded).cwiseMax(kSmallest);
  MatrixXd out = MatrixXd::Zero(own.rows(), own.cols());
  out(some, some) = directions * along.asDiagonal() * directions.transpose();
  return out;
}

/// See recorded_problem.hpp. Whether simulations tell it.
bool take_from_simulations(const calibrate::Observation& recorded, const Bank& bank, std::size_t condition, MatrixXd& covariance) {
  if (!recorded.of_tracks() || recorded.resampled.size() == 0) return false;
  const MatrixXd simulated = by_simulations(recorded.resampled, bank, condition);
  if (simulated.size() == 0) return false;
  const double few = calibrate::few_blocks_factor(recorded.blocks);
  const VectorXd others = (recorded.covariance - few * recorded.resampled).diagonal().cwiseMax(0);
  covariance = raised(simulated, recorded.resampled, std::exp(-kSurely * std::sqrt(2 / std::max(1.0, recorded.blocks))));
  covariance.diagonal() += others;
  return true;
}

}  // namespace

void add_recorded(const Question& question, const Evidence& evidence, const Bank& bank, const std::vector<std::size_t>& conditions,
                  naming::Problem& problem) {
  Index n = 0;
  for (const std::size_t c : conditions) n += evidence.recorded[c].value.size();
  problem.observed.resize(n);
  problem.covariance = MatrixXd::Zero(n, n);
  Index at = 0;
  for (const std::size_t c : conditions) {
    const calibrate::Observation& o = evidence.recorded[c];
    const Index size = o.value.size();
    MatrixXd covariance = o.covariance;
    if (take_from_simulations(o, bank, c, covariance)) problem.sizes.push_back({at, size, o.blocks - 1});
    calibrate::add_power_error(o, question.study.power_error, covariance);
    problem.observed.segment(at, size) = o.value;
    problem.covariance.block(at, at, size, size) = covariance;
    at += size;
  }
}

naming::Problem problem_of(const Question& question, const Evidence& evidence, const Bank& bank,
                           const std::vector<std::size_t>& conditions) {
  naming::Problem p;
  p.data = data_of(question, bank, conditions);
  p.alternatives = alternatives_of(question);
  add_recorded(question, evidence, bank, conditions, p);
  naming::choose_scales(p.data);
  return p;
}

naming::Problem problem_alone(const Question& question, const Evidence& evidence, const Bank& bank, std::size_t condition,
                              const naming::BankData& like) {
  naming::Problem p;
  p.data = data_of(question, bank, {condition});
  for (std::size_t i = 0; i < p.data.theta.size(); ++i) p.data.theta[i].logarithmic = like.theta[i].logarithmic;
  add_recorded(question, evidence, bank, {condition}, p);
  return p;
}

std::vector<naming::Alternative> alternatives_of(const Question& question) {
  std::vector<naming::Alternative> alternatives;
  for (Index j = 0; j < std::ssize(question.candidates); ++j) {
    const Candidate& c = question.candidates[j];
    alternatives.push_back({.name = c.name,
                            .candidate = j,
                            .range = c.on_or_off() ? naming::StrengthRange{1, 1} : c.range,
                            .prior = c.on_or_off() ? naming::StrengthRange{1, 1} : c.prior,
                            .excludes = c.excludes});
  }
  Index coordinate = std::ssize(question.study.parameters);
  const std::vector<naming::Coordinate> coordinates = question.coordinates();
  for (const Nuisance& n : question.nuisances) {
    const naming::Coordinate& c = coordinates[coordinate];
    alternatives.push_back(
        {.name = n.name, .freed = coordinate++, .prior = naming::StrengthRange{c.coded(n.asked.low), c.coded(n.asked.high)}});
  }
  return alternatives;
}

}  // namespace millscope::diagnose
