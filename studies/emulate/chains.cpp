#include "studies/emulate/chains.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double mirrored(double u) {
  u = std::fmod(u + 1, 4);
  if (u < 0) u += 4;
  return (u > 2 ? 4 - u : u) - 1;
}

}  // namespace

Population::Population(const LogDensity& density, const MatrixXd& prior_points, int chains, std::uint64_t seed, std::uint64_t stream)
    : density_(density),
      random_(seed, stream),
      mixture_(density, prior_points, random_),
      position_(mixture_.starts(chains, random_)),
      value_(chains) {
  for (Index c = 0; c < chains; ++c) value_[c] = density(position_.col(c));
}

VectorXd Population::difference_step(Index chain) {
  constexpr double kJitter = 1e-4, kLongSteps = 0.1;
  const Index n = position_.rows(), count = position_.cols();
  const auto other = [&](Index a, Index b) {
    Index pick = a;
    while (pick == a || pick == b) pick = static_cast<Index>(random_.below(static_cast<std::uint64_t>(count)));
    return pick;
  };
  const Index a = other(chain, chain), b = other(chain, a);
  const double gamma = random_.uniform() < kLongSteps ? 1.0 : 2.38 / std::sqrt(2.0 * static_cast<double>(n));
  const VectorXd proposal = position_.col(chain) + gamma * (position_.col(a) - position_.col(b)) + kJitter * random_.normals(n);
  return proposal.unaryExpr(&mirrored);
}

void Population::step(Index chain) {
  constexpr double kFromMixture = 0.1;
  if (random_.uniform() < kFromMixture) {
    const VectorXd proposal = mixture_.draw(random_);
    accept(chain, proposal, mixture_.log_density(position_.col(chain)) - mixture_.log_density(proposal));
  } else {
    accept(chain, difference_step(chain), 0);
  }
}

void Population::accept(Index chain, const VectorXd& proposal, double log_correction) {
  const double value = density_(proposal);
  ++proposed_;
  if (std::log(1 - random_.uniform()) > value - value_[chain] + log_correction) return;
  ++accepted_;
  position_.col(chain) = proposal;
  value_[chain] = value;
}

void Population::sample(int draws) {
  const Index count = position_.cols();
  draws_.assign(count, MatrixXd(position_.rows(), draws));
  values_.assign(count, VectorXd(draws));
  accepted_ = 0;
  proposed_ = 0;
  for (Index t = 0; t < draws; ++t) {
    for (Index chain = 0; chain < count; ++chain) {
      step(chain);
      draws_[chain].col(t) = position_.col(chain);
      values_[chain][t] = value_[chain];
    }
  }
}

Agreement agreement(const std::vector<VectorXd>& chains) {
  std::vector<VectorXd> halves;
  const Index n = chains.front().size() / 2;
  for (const VectorXd& chain : chains) {
    halves.emplace_back(chain.head(n));
    halves.emplace_back(chain.tail(n));
  }
  const auto m = static_cast<Index>(halves.size());
  const auto length = static_cast<double>(n);
  VectorXd means(m);
  double within = 0;
  for (Index c = 0; c < m; ++c) {
    VectorXd& half = halves[c];
    means[c] = half.mean();
    half.array() -= means[c];
    within += half.squaredNorm() / (length - 1) / static_cast<double>(m);
  }
  const double between = (means.array() - means.mean()).square().sum() / static_cast<double>(m - 1);
  const double variance = (length - 1) / length * within + between;
  if (!(within > 0)) return {between > 0 ? INFINITY : 1.0, static_cast<double>(m)};
  // Autocorrelation by lag over all halves; pairs are added up while their sum is positive (Geyer 1992).
  double sum = 0, pair = 0;
  for (Index lag = 1; lag < n - 1; ++lag) {
    double products = 0;
    for (const VectorXd& half : halves) products += half.head(n - lag).dot(half.tail(n - lag)) / (length - 1);
    pair += 1 - (within - products / static_cast<double>(m)) / variance;
    if (lag % 2 == 1) continue;
    if (pair < 0) break;
    sum += pair;
    pair = 0;
  }
  return {std::sqrt(variance / within), static_cast<double>(m) * length / (1 + 2 * sum)};
}

}  // namespace millscope::emulate
