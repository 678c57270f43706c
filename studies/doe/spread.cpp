// Plans that fill the box: Latin hypercubes and Sobol's sequence.
#include <fmt/format.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <numeric>

#include "kernel/base/error.hpp"
#include "millscope/observation_adapter.hpp"
#include "studies/doe/doe.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/doe/sequences.hpp"

namespace millscope::doe {
namespace {

constexpr int kDraws = 100;

void check_runs(int runs, int least) {
  if (runs < least || runs > 65536) throw base::UserError(fmt::format("{} runs; give {} to 65536", runs, least));
}

/// One run in the middle of each layer of each factor, coded.
Eigen::MatrixXd draw_hypercube(Eigen::Index runs, Eigen::Index factors, Random& dice) {
  Eigen::MatrixXd coded(runs, factors);
  std::vector<Eigen::Index> layer(runs);
  for (Eigen::Index i = 0; i < factors; ++i) {
    std::iota(layer.begin(), layer.end(), 0);
    for (std::size_t left = layer.size(); left > 1; --left) {
      std::swap(layer[left - 1], layer[static_cast<std::size_t>(dice.uniform() * static_cast<double>(left))]);
    }
    for (Eigen::Index run = 0; run < runs; ++run) {
      coded(run, i) = (2 * static_cast<double>(layer[run]) + 1) / static_cast<double>(runs) - 1;
    }
  }
  return coded;
}

double closest_pair(const Eigen::MatrixXd& points) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index a = 1; a < points.rows(); ++a) {
    least = std::min(least, (points.topRows(a).rowwise() - points.row(a)).rowwise().squaredNorm().minCoeff());
  }
  return least;
}

Design spread(std::vector<Factor> factors, Eigen::MatrixXd coded) {
  Design design;
  design.kind.assign(coded.rows(), "spread");
  design.coded = std::move(coded);
  design.factors = std::move(factors);
  return design;
}

}  // namespace

Eigen::MatrixXd sobol_points(Eigen::Index points, Eigen::Index dimensions) {
  boost::random::sobol engine(dimensions);
  Eigen::MatrixXd unit(points, dimensions);
  for (Eigen::Index point = 0; point < points; ++point) {
    for (Eigen::Index i = 0; i < dimensions; ++i) unit(point, i) = static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  return unit;
}

Design latin_hypercube(std::vector<Factor> factors, int runs, std::uint64_t seed) {
  check(factors);
  check_runs(runs, 2);
  Random dice(seed);
  Eigen::MatrixXd best;
  double farthest = -1;
  for (int draw = 0; draw < (runs > 1000 ? 1 : kDraws); ++draw) {  // beyond, comparing draws takes longer than it is worth
    Eigen::MatrixXd coded = draw_hypercube(runs, static_cast<Eigen::Index>(factors.size()), dice);
    const double distance = closest_pair(coded);
    if (distance <= farthest) continue;
    farthest = distance;
    best = std::move(coded);
  }
  return spread(std::move(factors), std::move(best));
}

Design sobol(std::vector<Factor> factors, int runs) {
  check(factors);
  check_runs(runs, 1);
  const Eigen::MatrixXd unit = sobol_points(runs, static_cast<Eigen::Index>(factors.size()));
  return spread(std::move(factors), 2 * unit.array() - 1);
}

}  // namespace millscope::doe
