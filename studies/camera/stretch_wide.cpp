// The restricted likelihood of noise_model.hpp: one filter runs over the data and over the powers of time, which generalised least squares
// removes. The three axes go side by side in one vector of four, whose last lane repeats the third: each lane has the bits that it would
// have alone.
//
// Built once per instruction set: plain data in and out, so that no function that others share is compiled for a machine that is not there.
#include "studies/camera/stretch_wide.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace millscope::camera::MILLSCOPE_WIDE {
namespace {

typedef double Four __attribute__((vector_size(4 * sizeof(double))));

constexpr int kSeries = 5;      // the data and the powers 0 to 3 of time
constexpr double kUsual = 1e6;  // 1/m², of a location: keeps the product near 1

Four four(const double* lanes) { return Four{lanes[0], lanes[1], lanes[2], lanes[2]}; }
Four at(const StretchView& s, std::size_t i) { return Four{s.x[i], s.y[i], s.z[i], s.z[i]}; }

struct State {
  Four x, v, c;
};

/// Symmetric 3×3.
struct Covariance {
  Four xx, xv, xc, vv, vc, cc;
};

Covariance advanced(const Covariance& p, const StretchView& s, std::size_t i, double strength, const Four& correlated) {
  const double time = s.memory, slowed = s.slowed[i], kept = s.kept[i], reach = time * (1 - slowed), q = strength * strength;
  return {p.xx + (reach * (2 * p.xv + reach * p.vv) + q * time * time * (s.dt[i] - 0.5 * time * (3 - slowed * (4 - slowed)))),
          slowed * (p.xv + reach * p.vv) + 0.5 * q * reach * reach,
          kept * (p.xc + reach * p.vc),
          slowed * slowed * p.vv + 0.5 * q * time * (1 - slowed * slowed),
          p.vc * (kept * slowed),
          kept * kept * p.cc + correlated * correlated * (1 - kept * kept)};
}

/// Sums over the innovations of the data (series 0) and of the functions that are removed from them.
struct Removal {
  Four sums[kSeries][kSeries] = {};  ///< lower triangle
  Four product = Four{} + 1.0, log_variance = Four{};

  void add(const Four* e, const Four& variance, const Four& weight) {
    product *= variance * kUsual;
    for (int lane = 0; lane < 3; ++lane) {  // one logarithm for many points
      if (product[lane] > 1e-100 && product[lane] < 1e100) continue;
      log_variance[lane] += product[lane] > 0 ? std::log(product[lane]) : std::numeric_limits<double>::quiet_NaN();
      product[lane] = 1;
    }
    for (int j = 0; j < kSeries; ++j) {
      const Four weighted = weight * e[j];
      for (int k = 0; k <= j; ++k) sums[j][k] += weighted * e[k];
    }
  }

  /// Cholesky from the last function down to the data: the last pivot is what the functions leave of the data.
  void log_likelihood(double count, double* found) {
    for (int pivot = kSeries - 1; pivot > 0; --pivot) {
      for (int j = 0; j < pivot; ++j) {
        const Four share = sums[pivot][j] / sums[pivot][pivot];
        for (int k = 0; k <= j; ++k) sums[j][k] -= share * sums[pivot][k];
      }
    }
    for (int lane = 0; lane < 3; ++lane) {
      double log_determinant = 0;
      for (int pivot = kSeries - 1; pivot > 0; --pivot) log_determinant += std::log(sums[pivot][pivot][lane]);
      const double of_variance = log_variance[lane] + (std::log(product[lane]) - count * std::log(kUsual));
      found[lane] = -0.5 * (of_variance + log_determinant + sums[0][0][lane] + (count - (kSeries - 1)) * std::log(2 * std::numbers::pi));
    }
  }
};

}  // namespace

void stretch_likelihood(const StretchView& s, const NoiseView& noise, double strength, double* log_likelihood_3) {
  const Four zero{}, white = four(noise.white), correlated = four(noise.correlated), first = at(s, 0);
  State state[kSeries] = {};
  Covariance p{zero, zero, zero, zero + 0.5 * strength * strength * s.memory, zero, correlated * correlated};
  Removal removal;
  const double half = 0.5 * s.time[s.count - 1];
  for (std::size_t i = 0; i < s.count; ++i) {
    const double f = s.factor[i];
    if (i > 0) {
      const double kept = s.kept[i], slowed = s.slowed[i], reach = s.memory * (1 - slowed);
      p = advanced(p, s, i, strength, correlated);
      for (State& x : state) x = {x.x + reach * x.v, slowed * x.v, kept * x.c};
    }
    const Four ux = p.xx + f * p.xc, uv = p.xv + f * p.vc, uc = p.xc + f * p.cc;
    const Four variance = ux + f * uc + f * f * white * white, weight = 1.0 / variance;
    const Four gain_x = ux * weight, gain_v = uv * weight, gain_c = uc * weight;
    const double t = s.time[i] / half - 1;
    const Four data[kSeries] = {at(s, i) - first, zero + 1.0, zero + t, zero + t * t, zero + t * t * t};
    Four e[kSeries];
    for (int k = 0; k < kSeries; ++k) {
      e[k] = data[k] - state[k].x - f * state[k].c;
      state[k] = {state[k].x + gain_x * e[k], state[k].v + gain_v * e[k], state[k].c + gain_c * e[k]};
    }
    p = {p.xx - gain_x * ux, p.xv - gain_x * uv, p.xc - gain_x * uc, p.vv - gain_v * uv, p.vc - gain_v * uc, p.cc - gain_c * uc};
    removal.add(e, variance, weight);
  }
  removal.log_likelihood(static_cast<double>(s.count), log_likelihood_3);
}

}  // namespace millscope::camera::MILLSCOPE_WIDE
