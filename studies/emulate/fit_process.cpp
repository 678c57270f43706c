#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "kernel/base/random.hpp"
#include "studies/emulate/process.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Lengths from a twentieth of the range to ten ranges; variances in units of the observable's own.
constexpr double kLogLength[2] = {-2.3, 3.0}, kLogVariance[2] = {-18.0, 4.6}, kLogNugget[2] = {-20.0, 0.5};

Shape shape_of(Kernel kernel, Trend trend, const VectorXd& x) {
  const Index p = x.size() - 2;
  return {kernel, trend, x.head(p), x[p], x[p + 1]};
}

/// NLopt reports a failure when a line search finds nothing more to gain: the best point is kept here instead.
struct Search {
  const Sample& sample;
  Kernel kernel;
  Trend trend;
  double best = -std::numeric_limits<double>::infinity();
  VectorXd at;

  double operator()(const VectorXd& x, double* slope) {
    try {
      VectorXd gradient;
      const double value = Process(sample, shape_of(kernel, trend, x)).log_likelihood(slope ? &gradient : nullptr);
      if (!std::isfinite(value)) return nowhere(x.size(), slope);
      if (slope) VectorXd::Map(slope, x.size()) = gradient;
      if (value > best) {
        best = value;
        at = x;
      }
      return value;
    } catch (const std::domain_error&) {
      return nowhere(x.size(), slope);
    }
  }
  static double nowhere(Index n, double* slope) {
    if (slope) VectorXd::Map(slope, n).setZero();
    return -1e30;
  }
};

double objective(unsigned count, const double* x, double* slope, void* data) {
  return (*static_cast<Search*>(data))(VectorXd::Map(x, count), slope);
}

/// The first starts from what is usual; the others from anywhere sensible.
VectorXd start_point(Index p, int start, base::RandomStream& random) {
  VectorXd x(p + 2);
  if (start == 0) {
    x.setConstant(0.7);
    x[p] = -1;
    x[p + 1] = -7;
    return x;
  }
  for (Index k = 0; k < p; ++k) x[k] = -1 + 3 * random.uniform();
  x[p] = -6 + 6 * random.uniform();
  x[p + 1] = -12 + 10 * random.uniform();
  return x;
}

}  // namespace

Process fit_process(const Sample& sample, Trend trend, const FitOptions& options, std::uint64_t stream) {
  const Index p = sample.input.rows();
  Search search{sample, options.kernel, trend, -std::numeric_limits<double>::infinity(), {}};
  VectorXd low = VectorXd::Constant(p + 2, kLogLength[0]), high = VectorXd::Constant(p + 2, kLogLength[1]);
  low.tail(2) << kLogVariance[0], kLogNugget[0];
  high.tail(2) << kLogVariance[1], kLogNugget[1];
  base::RandomStream random(options.seed, stream);
  for (int start = 0; start < options.starts; ++start) {
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> tool(nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(p + 2)),
                                                                      nlopt_destroy);
    nlopt_set_lower_bounds(tool.get(), low.data());
    nlopt_set_upper_bounds(tool.get(), high.data());
    nlopt_set_max_objective(tool.get(), objective, &search);
    nlopt_set_ftol_abs(tool.get(), 1e-5);
    nlopt_set_maxeval(tool.get(), 200);
    VectorXd x = start_point(p, start, random).cwiseMax(low).cwiseMin(high);
    double value = 0;
    nlopt_optimize(tool.get(), x.data(), &value);
  }
  if (search.at.size() == 0) throw std::domain_error("no hyper-parameters fit");
  return {sample, shape_of(options.kernel, trend, search.at)};
}

}  // namespace millscope::emulate
