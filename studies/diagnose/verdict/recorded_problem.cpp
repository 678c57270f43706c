#include "studies/diagnose/verdict/recorded_problem.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/calibrate/power.hpp"
#include "studies/diagnose/naming/noise.hpp"
#include "studies/diagnose/naming/surrogate.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kSurely = 3.09;    // normal: 99.9 %
constexpr double kLikely = 1.645;   // 95 %: an error taken for too small is the worse mistake
constexpr double kSmallest = 1e-6;  // of a variance, left of sums that are always the same: one number that is compared twice
// Directions that tell as much of the common size as one whose blocks are independent would. Tried: the size of one recording scatters by 4
// to 8 % (bench/look_errors.py), which is 340 to 1200 degrees of freedom; a third of 33 directions of 32 to 58 blocks is 340 to 630.
constexpr double kDirectionsForOne = 3;
constexpr double kFewBlocks = 30;  // nobody has tried fewer: then the size is as unsure as one direction

/// Of the variances of two covariances the median ratio, where both have some.
double median_ratio(const MatrixXd& own, const MatrixXd& other) {
  std::vector<double> ratios;
  for (Index i = 0; i < own.rows(); ++i) {
    if (own(i, i) > 0 && other(i, i) > 0) ratios.push_back(own(i, i) / other(i, i));
  }
  return ratios.empty() ? 0 : base::quantile(ratios, 0.5);
}

/// What resampling says of a condition's simulations without a candidate, on average, each scaled to the recording's variances: their
/// shape. Empty where there is none.
MatrixXd shape_of(const MatrixXd& own, const Bank& bank, std::size_t condition) {
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

/// The mean of the ratios that chance lets differ so (99.9 %), and their number. The others are a recording's own: a camera that wanders, a
/// region that only simulated beads visit.
std::pair<double, Index> common_size(std::vector<double> ratios, double degrees) {
  std::erase_if(ratios, [](double ratio) { return !(ratio > 0); });
  if (ratios.empty()) return {1, 0};
  const double middle = base::quantile(ratios, 0.5) / naming::variance_at(degrees, 0);
  const double least = naming::variance_at(degrees, -kSurely) * middle, most = naming::variance_at(degrees, kSurely) * middle;
  std::erase_if(ratios, [&](double ratio) { return ratio < least || ratio > most; });
  if (ratios.empty()) return {middle, 0};
  return {std::accumulate(ratios.begin(), ratios.end(), 0.0) / static_cast<double>(ratios.size()), std::ssize(ratios)};
}

/// A shape as large as the recording's own errors, and of how many directions that is the mean. Every direction counts alike, as in a
/// misfit: the variances of the numbers hang on the few directions that are slow, which a recording knows worst.
struct Sized {
  MatrixXd covariance;
  Index directions = 0;
};

/// In those of the shape's own directions in which the recording likely has more, what it has there.
Sized sized(const MatrixXd& shape, const MatrixXd& own, double degrees) {
  const VectorXd variance = shape.diagonal().cwiseMax(own.diagonal());
  std::vector<Index> some;
  for (Index i = 0; i < variance.size(); ++i) {
    if (variance[i] > 0) some.push_back(i);
  }
  const VectorXd unit = variance(some).cwiseSqrt(), per_unit = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(per_unit.asDiagonal() * shape(some, some) * per_unit.asDiagonal());
  const MatrixXd directions = unit.asDiagonal() * solver.eigenvectors(), across = per_unit.asDiagonal() * solver.eigenvectors();
  const VectorXd recorded = (across.transpose() * own(some, some) * across).diagonal();
  std::vector<double> ratios;
  for (Index i = 0; i < recorded.size(); ++i) {
    if (solver.eigenvalues()[i] > kSmallest) ratios.push_back(recorded[i] / solver.eigenvalues()[i]);
  }
  const auto [size, alike] = common_size(std::move(ratios), degrees);
  const VectorXd known = size * solver.eigenvalues().cwiseMax(kSmallest);
  const VectorXd along = (recorded.array() > naming::variance_at(degrees, kLikely) * known.array()).select(recorded, known);
  Sized out{MatrixXd::Zero(own.rows(), own.cols()), alike};
  out.covariance(some, some) = directions * along.asDiagonal() * directions.transpose();
  return out;
}

/// The errors of one condition, and of which of its numbers they are known but for their common size.
struct Errors {
  MatrixXd covariance;
  naming::CommonSize size = {};
};

/// See recorded_problem.hpp.
Errors errors_of(const calibrate::Observation& recorded, const Bank& bank, std::size_t condition) {
  if (!recorded.of_tracks() || recorded.resampled.size() == 0) return {recorded.covariance};
  const MatrixXd shape = shape_of(recorded.resampled, bank, condition);
  if (shape.size() == 0) return {recorded.covariance};
  const double degrees = std::max(1.0, recorded.blocks - 1);
  Errors out;
  const MatrixXd resampled = calibrate::few_blocks_factor(recorded.blocks) * recorded.resampled;
  const VectorXd others = (recorded.covariance - resampled).diagonal().cwiseMax(0);
  const Sized found = sized(shape, recorded.resampled, degrees);
  out.covariance = found.covariance;
  const double alike = recorded.blocks < kFewBlocks ? 1 : static_cast<double>(found.directions) / kDirectionsForOne;
  out.size.degrees = std::max(1.0, alike) * degrees;
  out.covariance.diagonal() += others;
  for (Index i = 0; i < others.size(); ++i) {  // those of which resampling tells most
    if (others[i] < 0.5 * out.covariance(i, i)) out.size.observables.push_back(i);
  }
  return out;
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
    Errors errors = errors_of(o, bank, c);
    calibrate::add_power_error(o, question.study.power_error, errors.covariance);
    problem.observed.segment(at, size) = o.value;
    problem.covariance.block(at, at, size, size) = errors.covariance;
    for (Index& i : errors.size.observables) i += at;
    if (!errors.size.observables.empty()) problem.sizes.push_back(std::move(errors.size));
    at += size;
  }
}

naming::Problem problem_of(const Question& question, const Evidence& evidence, const Bank& bank,
                           const std::vector<std::size_t>& conditions) {
  naming::Problem p;
  p.data = data_of(question, bank, conditions);
  p.alternatives = alternatives_of(question);
  add_recorded(question, evidence, bank, conditions, p);
  naming::choose_terms(p.data, p.covariance);
  return p;
}

naming::Problem problem_alone(const Question& question, const Evidence& evidence, const Bank& bank, std::size_t condition,
                              const naming::BankData& like) {
  naming::Problem p;
  p.data = data_of(question, bank, {condition});
  for (std::size_t i = 0; i < p.data.theta.size(); ++i) p.data.theta[i].logarithmic = like.theta[i].logarithmic;
  p.data.degree = like.degree;
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
