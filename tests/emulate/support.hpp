// Problems with known answers.
#pragma once

#include <cmath>

#include "kernel/base/random.hpp"
#include "studies/emulate/emulator.hpp"

namespace millscope::emulate::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Function = std::function<VectorXd(const VectorXd&)>;

inline Box unit_box(Index parameters) { return {VectorXd::Zero(parameters), VectorXd::Ones(parameters)}; }

/// Latin hypercube in the box: parameters × runs.
inline MatrixXd latin(const Box& box, Index runs, std::uint64_t seed) {
  base::RandomStream random(seed, 77);
  MatrixXd points(box.size(), runs);
  for (Index k = 0; k < box.size(); ++k) {
    std::vector<Index> order(static_cast<std::size_t>(runs));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (Index i = 0; i < runs; ++i) {
      const double part = (static_cast<double>(order[i]) + random.uniform()) / static_cast<double>(runs);
      points(k, i) = box.lower[k] + part * (box.upper[k] - box.lower[k]);
    }
  }
  return points;
}

/// Runs of a function with normal noise of this standard deviation.
inline Training runs_of(const Function& f, const MatrixXd& points, double noise, std::uint64_t seed) {
  base::RandomStream random(seed, 78);
  const Index q = f(points.col(0)).size(), n = points.cols();
  Training t{points.transpose(), MatrixXd(n, q), MatrixXd::Constant(n, q, noise * noise)};
  for (Index i = 0; i < n; ++i) t.output.row(i) = (f(points.col(i)) + noise * random.normals(q)).transpose();
  return t;
}

}  // namespace millscope::emulate::test
