#include "studies/diagnose/verdict/recorded_problem.hpp"

#include <algorithm>

#include "studies/calibrate/power.hpp"
#include "studies/diagnose/naming/surrogate.hpp"

namespace millscope::diagnose {
namespace {

/// Mean correlation of the simulated observations of a condition; the identity where the bank has none.
MatrixXd correlation_of(const Bank& bank, std::size_t condition, Index size) {
  const std::optional<std::size_t> k = bank.place_of(condition);
  MatrixXd sum = MatrixXd::Zero(size, size);
  int runs = 0;
  for (const auto& seen : bank.seen) {
    if (!k || !seen[*k]) continue;
    const MatrixXd& covariance = seen[*k]->covariance;
    const VectorXd scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    sum += scale.asDiagonal() * covariance * scale.asDiagonal();
    ++runs;
  }
  return runs == 0 ? MatrixXd(MatrixXd::Identity(size, size)) : MatrixXd(sum / runs);
}

}  // namespace

void add_recorded(const Question& question, const Evidence& evidence, const Bank& bank, const std::vector<std::size_t>& conditions,
                  naming::Problem& problem) {
  Index n = 0;
  for (const std::size_t c : conditions) n += evidence.recorded[c].value.size();
  problem.observed.resize(n);
  problem.covariance = MatrixXd::Zero(n, n);
  problem.noise.assign(2, problem.covariance);
  Index at = 0;
  for (const std::size_t c : conditions) {
    const calibrate::Observation& o = evidence.recorded[c];
    const Index size = o.value.size();
    const VectorXd deviation = o.covariance.diagonal().cwiseSqrt();
    problem.observed.segment(at, size) = o.value;
    MatrixXd own = o.covariance, simulated = own;  // a profile's errors are stated, its correlations too
    if (o.of_tracks()) simulated = deviation.asDiagonal() * correlation_of(bank, c, size) * deviation.asDiagonal();
    for (MatrixXd* covariance : {&own, &simulated}) calibrate::add_power_error(o, question.study.power_error, *covariance);
    problem.noise[0].block(at, at, size, size) = own;
    problem.noise[1].block(at, at, size, size) = simulated;
    problem.covariance.block(at, at, size, size) = 0.5 * (own + simulated);
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
