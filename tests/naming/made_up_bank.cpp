#include "made_up_bank.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>

#include "kernel/base/random.hpp"

namespace millscope::naming {
namespace {

/// A fixed direction in the space of observables.
VectorXd direction(const MadeUp& mill, std::uint64_t number) {
  base::RandomStream random(4711, number);
  return random.normals(mill.conditions * mill.observables);
}

/// The first points of Sobol' in -1 … 1.
MatrixXd spread(int runs, int dimensions) {
  boost::random::sobol engine(static_cast<std::size_t>(dimensions));
  MatrixXd coded(runs, dimensions);
  for (Index run = 0; run < runs; ++run) {
    for (Index i = 0; i < dimensions; ++i) coded(run, i) = 2 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1;
  }
  return coded;
}

/// From 0 to 1, level at both ends.
double slow_step(double x) { return x * x * (3 - 2 * x); }

/// How much of what is visible a strength does.
double visible_of(const MadeUp& mill, double s) {
  if (mill.goes_again) return 4 * s * (1 - s);
  return mill.whole > 0 ? slow_step(std::min(1.0, s / mill.whole)) : s;
}

}  // namespace

VectorXd truth_of(const MadeUp& mill, const VectorXd& u, const std::vector<double>& s) {
  VectorXd y =
      3 * direction(mill, 1) * (u[0] - 0.5 * mill.flattens * u[0] * u[0]) + 2 * direction(mill, 2) * u[1] + 1.5 * direction(mill, 3) * u[2];
  y += 0.8 * direction(mill, 4) * u[0] * u[0] + 0.5 * direction(mill, 5) * u[0] * u[1];
  const double visible = visible_of(mill, s[0]);
  y += visible * (2.5 * direction(mill, 6) + 2 * direction(mill, 1)) + 0.5 * visible * u[0] * direction(mill, 7);
  y += s[1] * direction(mill, 1);
  y += s[2] * 0.02 * direction(mill, 8);
  y += mill.cubic * (direction(mill, 9) * u[0] * u[0] * u[0] + direction(mill, 10) * u[0] * u[1] * u[1]);
  return y;
}

Problem made_up_problem(const MadeUp& mill, const VectorXd& coded, const std::vector<double>& strengths, std::uint64_t seed) {
  Problem p;
  p.data.theta = {{"bead_friction", -1, 1, 0, 0, false}, {"wall_friction", -1, 1, 0, 0, false}, {"filling", -1, 1, 0, 0.35, false}};
  p.data.candidates = 3;
  const char* names[] = {"visible", "concealed", "faint"};
  for (Index j = 0; j < 3; ++j) p.alternatives.push_back({.name = names[j], .candidate = j});
  p.alternatives.push_back({.name = "filling", .freed = 2});
  const MatrixXd base = spread(mill.runs, 3), with = spread(3 * mill.each, 4);
  base::RandomStream random(seed, 0);
  const Index n = mill.conditions * mill.observables;
  std::vector<VectorXd> values;
  const auto add = [&](const VectorXd& u, std::optional<Index> candidate, double strength) {
    std::vector<double> s(3, 0.0);
    if (candidate) s[*candidate] = strength;
    p.data.rows.push_back({u, candidate ? std::vector<ActiveCandidate>{{*candidate, strength}} : std::vector<ActiveCandidate>{}});
    values.push_back(truth_of(mill, u, s) + (candidate ? mill.chancier : 1) * mill.run_noise * random.normals(n));
  };
  for (Index r = 0; r < base.rows(); ++r) add(base.row(r).transpose(), {}, 0);
  for (Index r = 0; r < mill.again; ++r) add(base.row(r).transpose(), {}, 0);
  for (Index r = 0; r < with.rows(); ++r) add(with.row(r).head(3).transpose(), r % 3, mill.weakest + (1 - mill.weakest) * with(r, 3));
  p.data.value.resize(static_cast<Index>(values.size()), n);
  for (std::size_t r = 0; r < values.size(); ++r) p.data.value.row(static_cast<Index>(r)) = values[r].transpose();
  for (Index i = 0; i < n; ++i) p.data.condition.push_back(static_cast<int>(i) / mill.observables);
  p.observed = truth_of(mill, coded, strengths) + mill.recording_noise * random.normals(n);
  p.covariance = MatrixXd::Identity(n, n) * mill.recording_noise * mill.recording_noise;
  return p;
}

}  // namespace millscope::naming
