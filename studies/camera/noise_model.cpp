#include "studies/camera/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace millscope::camera {
namespace {

/// From a bed turning as one body to impacts, in steps of a factor of two and a half, m/s^1.5.
constexpr Rungs kLadder{0.008, 0.02, 0.05, 0.125, 0.3, 0.8, 2.0, 5.0, 12.5};
static_assert(kLadder.back() > 0, "Rungs has room for more strengths than there are");

using State = std::array<double, 3>;  ///< x, v, c

/// Symmetric 3×3.
struct Covariance {
  double xx = 0, xv = 0, xc = 0, vv = 0, vc = 0, cc = 0;

  void advance(const Steps& steps, std::size_t i, double strength, double correlated) {
    const double time = steps.memory, slowed = steps.slowed[i], kept = steps.kept[i], reach = time * (1 - slowed), q = strength * strength;
    xx += reach * (2 * xv + reach * vv) + q * time * time * (steps.dt[i] - 0.5 * time * (3 - slowed * (4 - slowed)));
    xv = slowed * (xv + reach * vv) + 0.5 * q * reach * reach;
    vv = slowed * slowed * vv + 0.5 * q * time * (1 - slowed * slowed);
    xc = kept * (xc + reach * vc);
    vc *= kept * slowed;
    cc = kept * kept * cc + correlated * correlated * (1 - kept * kept);
  }
};

constexpr std::size_t kSeries = 5;  ///< the data and the powers 0 to 3 of time

/// Sums over the innovations of the data (series 0) and of the functions that are removed from them.
class Removal {
 public:
  void add(const std::array<double, kSeries>& e, double variance, double weight) {
    product_ *= variance > 0 ? variance * kUsual : std::numeric_limits<double>::quiet_NaN();
    if (!(product_ > 1e-100 && product_ < 1e100)) log_variance_ += std::log(product_), product_ = 1;  // one logarithm for many points
    ++count_;
    for (std::size_t j = 0; j < kSeries; ++j) {
      const double weighted = weight * e[j];
      for (std::size_t k = 0; k <= j; ++k) sums_[j][k] += weighted * e[k];
    }
  }

  /// Restricted likelihood. Cholesky from the last function down to the data: the last pivot is what the functions leave of the data.
  double log_likelihood() {
    const double count = static_cast<double>(count_);
    log_variance_ += std::log(product_) - count * std::log(kUsual);
    double log_determinant = 0;
    for (std::size_t pivot = kSeries - 1; pivot > 0; --pivot) {
      log_determinant += std::log(sums_[pivot][pivot]);
      for (std::size_t j = 0; j < pivot; ++j) {
        const double share = sums_[pivot][j] / sums_[pivot][pivot];
        for (std::size_t k = 0; k <= j; ++k) sums_[j][k] -= share * sums_[pivot][k];
      }
    }
    const double free = count - static_cast<double>(kSeries - 1);
    return -0.5 * (log_variance_ + log_determinant + sums_[0][0] + free * std::log(2 * std::numbers::pi));
  }

 private:
  std::array<std::array<double, kSeries>, kSeries> sums_{};  ///< lower triangle
  static constexpr double kUsual = 1e6;                      // 1/m², of a location: keeps the product near 1
  double log_variance_ = 0, product_ = 1;
  std::size_t count_ = 0;
};

double averaged(const Rungs& relative, const Rungs& weight) {
  return std::inner_product(relative.begin(), relative.end(), weight.begin(), 0.0);
}

/// The likeliest weights, by a fixed number of rounds of expectation and maximisation from equal ones. So the likelihood stays smooth in
/// the parameters, and rungs that the data hardly tell apart keep nearly equal weights; the logarithm of the likelihood is then 0.2 to 1.5
/// short of its maximum over the weights. To the end, the errors of short recordings could not be found.
Rungs likely_weights(const std::vector<Rungs>& relative) {
  constexpr int kRounds = 60;
  Rungs weight;
  weight.fill(1.0 / static_cast<double>(weight.size()));
  for (int round = 0; round < kRounds; ++round) {
    Rungs sum{};
    for (const Rungs& r : relative) {
      const double all = averaged(r, weight);
      for (std::size_t k = 0; k < r.size(); ++k) sum[k] += weight[k] * r[k] / all;
    }
    for (std::size_t k = 0; k < sum.size(); ++k) weight[k] = sum[k] / static_cast<double>(relative.size());
  }
  return weight;
}

}  // namespace

Steps::Steps(const Stretch& stretch, double correlation_time, double memory_time, double growth) : memory(memory_time) {
  for (std::size_t i = 0; i < stretch.time.size(); ++i) {
    dt.push_back(i > 0 ? stretch.time[i] - stretch.time[i - 1] : 0.0);
    kept.push_back(std::exp(-dt[i] / correlation_time));
    slowed.push_back(std::exp(-dt[i] / memory));
    factor.push_back(1 + growth * stretch.distance[i]);
  }
}

double stretch_likelihood(const Stretch& s, std::size_t axis, const Steps& steps, const NoiseStrength& noise, double strength) {
  // The same filter runs over the data and over the powers of time; generalised least squares removes the powers.
  std::array<State, kSeries> state{};
  Covariance p;
  p.cc = noise.correlated * noise.correlated;
  p.vv = 0.5 * strength * strength * steps.memory;
  Removal removal;
  const double half = 0.5 * s.time.back();
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    const double f = steps.factor[i];
    if (i > 0) {
      const double kept = steps.kept[i], slowed = steps.slowed[i], reach = steps.memory * (1 - slowed);
      p.advance(steps, i, strength, noise.correlated);
      for (State& x : state) x = {x[0] + reach * x[1], slowed * x[1], kept * x[2]};
    }
    const double ux = p.xx + f * p.xc, uv = p.xv + f * p.vc, uc = p.xc + f * p.cc;
    const double variance = ux + f * uc + f * f * noise.white * noise.white, t = s.time[i] / half - 1;
    const std::array<double, kSeries> data{s.value[axis][i] - s.value[axis][0], 1.0, t, t * t, t * t * t};
    const double weight = 1 / variance, gain_x = ux * weight, gain_v = uv * weight, gain_c = uc * weight;
    std::array<double, kSeries> e;
    for (std::size_t k = 0; k < kSeries; ++k) {
      e[k] = data[k] - state[k][0] - f * state[k][2];
      state[k] = {state[k][0] + gain_x * e[k], state[k][1] + gain_v * e[k], state[k][2] + gain_c * e[k]};
    }
    p = {p.xx - gain_x * ux, p.xv - gain_x * uv, p.xc - gain_x * uc, p.vv - gain_v * uv, p.vc - gain_v * uc, p.cc - gain_c * uc};
    removal.add(e, variance, weight);
  }
  return removal.log_likelihood();
}

Rungs rung_likelihoods(const Stretch& s, std::size_t axis, const Steps& steps, const NoiseStrength& noise) {
  Rungs log{};
  for (std::size_t k = 0; k < kLadder.size(); ++k) log[k] = stretch_likelihood(s, axis, steps, noise, kLadder[k]);
  return log;
}

std::vector<double> averaged_over_ladder(const std::vector<Rungs>& logs) {
  std::vector<Rungs> relative;  // likelihoods over the best rung's
  std::vector<double> best;
  for (const Rungs& log : logs) {
    best.push_back(*std::max_element(log.begin(), log.end()));
    Rungs& r = relative.emplace_back();
    for (std::size_t k = 0; k < r.size(); ++k) r[k] = std::exp(log[k] - best.back());
  }
  const Rungs weight = likely_weights(relative);
  std::vector<double> result;
  for (std::size_t i = 0; i < logs.size(); ++i) result.push_back(best[i] + std::log(averaged(relative[i], weight)));
  return result;
}

}  // namespace millscope::camera
