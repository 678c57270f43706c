#include "studies/emulate/posterior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernel/base/parallel.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/emulate/chains.hpp"
#include "studies/emulate/likelihood.hpp"
#include "studies/emulate/prior.hpp"
#include "studies/emulate/statements.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPopulations = 2, kPriorDraws = 4000;
constexpr int kLearning = 300;  // draws per parameter and round for the mixture
constexpr double kEdge = 0.01;  // of coded units: half a hundredth of the range
constexpr double kMostRHat = 1.05, kLeastEffective = 400;

double quantile(const VectorXd& sorted, double fraction) {
  return base::interpolated_quantile({sorted.data(), static_cast<std::size_t>(sorted.size())}, fraction);
}

VectorXd sorted(VectorXd values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// Width of the 90 % interval before the data.
VectorXd prior_widths(const Box& box, std::uint64_t seed) {
  if (!box.allowed) return 0.9 * (box.upper - box.lower);
  const MatrixXd points = prior_points(box, kPriorDraws, seed + 1);
  VectorXd widths(box.size());
  for (Index k = 0; k < box.size(); ++k) {
    const VectorXd values = sorted(points.row(k).transpose());
    widths[k] = quantile(values, 0.95) - quantile(values, 0.05);
  }
  return widths;
}

std::vector<VectorXd> chains_of(const std::vector<Population>& populations, Index parameter) {
  std::vector<VectorXd> chains;
  for (const Population& population : populations) {
    for (const MatrixXd& draws : population.draws()) chains.emplace_back(draws.row(parameter).transpose());
  }
  return chains;
}

bool agreed(const std::vector<Population>& populations, Index parameters) {
  for (Index k = 0; k < parameters; ++k) {
    const Agreement a = agreement(chains_of(populations, k));
    if (!(a.r_hat < kMostRHat && a.effective >= kLeastEffective)) return false;
  }
  return true;
}

std::vector<Population> run_chains(const Likelihood& likelihood, const SamplerOptions& options) {
  const Index p = likelihood.box().size();
  const int chains = options.chains > 0 ? options.chains : 2 * static_cast<int>(p) + 4;
  if (chains < 4 || options.draws < 20) throw std::invalid_argument("SamplerOptions: at least 4 chains and 20 draws");
  const LogDensity density = [&](const VectorXd& coded) { return likelihood.log_density(coded); };
  std::vector<Population> populations;
  for (std::uint64_t stream = 0; stream < kPopulations; ++stream) {
    MatrixXd candidates = prior_points(likelihood.box(), kLearning * static_cast<int>(p), options.seed + 1000 * stream);
    for (Index i = 0; i < candidates.cols(); ++i) candidates.col(i) = likelihood.box().coded(candidates.col(i));
    populations.emplace_back(density, candidates, chains, options.seed, stream);
  }
  const std::size_t workers = base::worker_count(options.threads, kPopulations);
  for (int doubling = 0, draws = options.draws; doubling <= options.doublings; ++doubling, draws *= 2) {
    base::for_each_item(kPopulations, workers, [&](std::size_t i, std::size_t) {
      if (doubling == 0) populations[i].sample(draws);
      populations[i].sample(draws);
    });
    if (agreed(populations, p)) break;
  }
  return populations;
}

void collect(Posterior& result, const std::vector<Population>& populations, const Box& box) {
  const auto chains = static_cast<Index>(populations.front().draws().size());
  const Index length = populations.front().draws().front().cols();
  result.samples.resize(kPopulations * chains * length, box.size());
  result.log_density.resize(result.samples.rows());
  Index row = 0;
  result.acceptance = 0;
  for (const Population& population : populations) {
    result.acceptance += population.acceptance() / kPopulations;
    for (std::size_t c = 0; c < population.draws().size(); ++c) {
      for (Index t = 0; t < length; ++t) {
        result.samples.row(row) = box.natural(population.draws()[c].col(t)).transpose();
        result.log_density[row++] = population.log_density()[c][t];
      }
    }
  }
}

/// Correlations; zero with what does not vary.
MatrixXd correlations(const MatrixXd& samples) {
  const MatrixXd about = samples.rowwise() - samples.colwise().mean();
  const VectorXd per = about.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  MatrixXd r = per.asDiagonal() * (about.transpose() * about) * per.asDiagonal();
  r.diagonal().setOnes();
  return r;
}

Marginal marginal(const VectorXd& draws, double prior_width, const std::vector<VectorXd>& chains) {
  const VectorXd s = sorted(draws);
  const double mean = draws.mean();
  const Agreement a = agreement(chains);
  Marginal m{};
  m.mean = mean;
  m.deviation = std::sqrt((draws.array() - mean).square().mean());
  m.median = quantile(s, 0.5);
  m.low90 = quantile(s, 0.05);
  m.high90 = quantile(s, 0.95);
  m.low50 = quantile(s, 0.25);
  m.high50 = quantile(s, 0.75);
  m.width_ratio = (m.high90 - m.low90) / prior_width;
  m.r_hat = a.r_hat;
  m.effective_draws = a.effective;
  return m;
}

}  // namespace

Posterior sample_posterior(const Emulator& emulator, const Box& box, const Observed& observed, const SamplerOptions& options) {
  const Likelihood likelihood(emulator, box, observed);
  const Index p = box.size();
  const std::vector<Population> populations = run_chains(likelihood, options);
  Posterior result{};
  collect(result, populations, box);
  result.correlation = correlations(result.samples);
  result.converged = agreed(populations, p);

  Index likeliest = 0;
  result.log_density.maxCoeff(&likeliest);
  const VectorXd widths = prior_widths(box, options.seed);
  const MatrixXd inverse = (result.correlation + 1e-9 * MatrixXd::Identity(p, p)).inverse();
  double step = 0;
  for (Index k = 0; k < p; ++k) {
    Marginal m = marginal(result.samples.col(k), widths[k], chains_of(populations, k));
    m.conditional_ratio = m.width_ratio / std::sqrt(std::max(1.0, inverse(k, k)));
    step = std::max(step, m.deviation / (box.upper[k] - box.lower[k]));
    result.marginal.push_back(std::move(m));
  }
  const VectorXd mode = climb(likelihood, box.coded(result.samples.row(likeliest).transpose()), 0.5 * step, options.seed);
  result.mode = box.natural(mode);
  result.misfit = likelihood.misfit(mode);
  for (Index k = 0; k < p; ++k) {
    Marginal& m = result.marginal[k];
    m.mode = result.mode[k];
    m.at_edge = std::abs(mode[k]) > 1 - kEdge;
  }
  add_statements(result, box, likelihood.observables());
  return result;
}

double log_density(const Emulator& emulator, const Box& box, const Observed& observed, const VectorXd& point) {
  return Likelihood(emulator, box, observed).log_density(box.coded(point));
}

}  // namespace millscope::emulate
