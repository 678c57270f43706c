#include "studies/calibrate/objective.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace millscope::calibrate {
namespace {

double rms_difference(const Histogram& a, const Histogram& b) {
  if (a.percent.size() != b.percent.size() || a.percent.empty()) {
    throw base::UserError(
        fmt::format("the distributions have {} and {} bins; analyse both with the same settings", a.percent.size(), b.percent.size()));
  }
  double squares = 0;
  for (std::size_t i = 0; i < a.percent.size(); ++i) squares += std::pow(b.percent[i] - a.percent[i], 2);
  return std::sqrt(squares / static_cast<double>(a.percent.size()));
}

}  // namespace

ChagasObjective chagas2015(const Observation& recorded, const Observation& simulated, const std::vector<Term>& terms) {
  ChagasObjective o;
  o.power = std::fabs(simulated.power.value - recorded.power.value);
  o.x = rms_difference(recorded.x, simulated.x);
  o.speed = rms_difference(recorded.speed, simulated.speed);
  for (const Term& term : terms) {
    for (Eigen::Index i = 0; i < recorded.value.size(); ++i) {
      if (recorded.observables[i].name != term.name()) continue;
      o.terms += term.weight * 100 * std::fabs((simulated.value[i] - recorded.value[i]) / recorded.value[i]);
    }
  }
  return o;
}

double misfit(const Observation& recorded, const Observation& simulated) {
  const Eigen::VectorXd r = simulated.value - recorded.value;
  const Eigen::MatrixXd c = recorded.covariance + simulated.covariance;
  const Eigen::LDLT<Eigen::MatrixXd> factors(c);
  return r.dot(factors.solve(r));
}

}  // namespace millscope::calibrate
