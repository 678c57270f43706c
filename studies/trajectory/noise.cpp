// Noise of the points, apart from the motion. In a window of some 60 points the motion is an integrated random walk of strength q, the
// noise n has standard deviation σ and correlation φ from one point to the next:
//   dv = √q dW,  dx = v dt,   n[k+1] = φ n[k] + σ √(1 − φ²) e[k],   y[k] = x[k] + n[k]
// σ, φ, q are those that make the window most likely (a filter with the state x, v, n). The median over windows spread over the run is
// hardly touched by impacts and outliers. φ is one number for the tracker: the median over the coordinates.
#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/recording/noise.hpp"
#include "studies/trajectory/pieces.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::trajectory {
namespace {

constexpr std::size_t kWindow = 60, kShortest = 20, kWindows = 40;
constexpr double kLargestCorrelation = 0.9;
constexpr double kLeastNoise = 1e-7;  // m

struct Guess {
  double log_noise, correlation, log_roughness;  // the noise as log σ²
};

/// −2 log likelihood without constants.
double cost(const double* t, const double* y, std::size_t count, const Guess& guess) {
  const double noise = std::exp(guess.log_noise), phi = guess.correlation, q = std::exp(guess.log_roughness);
  // At the first point x = y − n; of the velocity nothing is known (10 m/s). Covariances: xx, xv, xn, vv, vn, nn.
  double x = y[0], v = 0, n = 0, xx = noise, xv = 0, xn = -noise, vv = 100, vn = 0, nn = noise, sum = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const double h = t[i] - t[i - 1];
    x += h * v;
    n *= phi;
    xx += h * (2 * xv + h * vv) + q * h * h * h / 3;
    xv += h * vv + q * h * h / 2;
    vv += q * h;
    xn = phi * (xn + h * vn);
    vn *= phi;
    nn = phi * phi * nn + noise * (1 - phi * phi);
    const double to_x = xx + xn, to_v = xv + vn, to_n = xn + nn, total = to_x + to_n, innovation = y[i] - x - n;
    if (i > 3) sum += innovation * innovation / total + std::log(total);
    const double weight = 1 / total, pull = innovation * weight;
    x += to_x * pull, v += to_v * pull, n += to_n * pull;
    xx -= to_x * to_x * weight, xv -= to_x * to_v * weight, xn -= to_x * to_n * weight;
    vv -= to_v * to_v * weight, vn -= to_v * to_n * weight, nn -= to_n * to_n * weight;
  }
  return sum;
}

/// Pattern search from `guess`; with `fixed` the correlation stays.
void improve(const double* t, const double* y, std::size_t count, bool fixed, Guess& guess) {
  constexpr double kFinest = 0.02;
  std::array<double, 3> step{0.5, 0.2, 1.5};
  double best = cost(t, y, count, guess);
  for (int round = 0; round < 60 && step[0] > kFinest; ++round) {
    bool better = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (fixed && k == 1) continue;
      for (const double sign : {1.0, -1.0}) {
        Guess other = guess;
        (k == 0 ? other.log_noise : k == 1 ? other.correlation : other.log_roughness) += sign * step[k];
        if (std::fabs(other.correlation) > kLargestCorrelation || other.log_noise < 2 * std::log(kLeastNoise)) continue;
        const double value = cost(t, y, count, other);
        if (!(value < best)) continue;
        best = value;
        guess = other;
        better = true;
        break;
      }
    }
    if (!better) {
      for (double& size : step) size /= 2;
    }
  }
}

/// Some points of a run.
struct Window {
  const recording::Run* run;
  Span span;
  void improve(std::size_t axis, bool fixed, Guess& guess) const {
    const Points points = points_of(*run, span);
    trajectory::improve(points.time, points.position[axis], points.count, fixed, guess);
  }
};

/// Spread evenly over all runs; short ones only where there are hardly any long ones.
std::vector<Window> windows_of(std::span<const recording::Run> runs, double gap_limit) {
  std::vector<Window> windows;
  for (const std::size_t length : {kWindow, kShortest}) {
    for (const recording::Run& run : runs) {
      for (const Span& span : unbroken(run, gap_limit)) {
        for (std::size_t first = span.first; first + length <= span.last; first += length)
          windows.push_back({&run, {first, first + length}});
      }
    }
    if (windows.size() >= 5) break;
  }
  std::vector<Window> chosen;
  const std::size_t count = std::min(kWindows, windows.size());
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(windows[k * windows.size() / count]);
  return chosen;
}

}  // namespace

NoiseEstimate estimate_noise_model(std::span<const recording::Run> runs, double gap_limit) {
  NoiseEstimate estimate;
  for (const recording::Run& run : runs) {
    const auto noise = recording::difference_noise(run, gap_limit);
    for (std::size_t axis = 0; axis < 3; ++axis)
      estimate.standard_deviation[axis] = std::max(estimate.standard_deviation[axis], noise[axis]);
  }
  const std::vector<Window> windows = windows_of(runs, gap_limit);
  if (windows.empty()) return estimate;
  std::array<std::vector<Guess>, 3> guesses;
  std::vector<double> correlations;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> found;
    const double start = 2 * std::log(std::max(estimate.standard_deviation[axis], kLeastNoise));
    for (const Window& window : windows) {
      Guess guess{start, 0.1, std::log(0.1)};
      window.improve(axis, false, guess);
      guesses[axis].push_back(guess);
      found.push_back(guess.correlation);
    }
    correlations.push_back(base::quantile(found, 0.5));
  }
  estimate.correlation = std::max(0.0, base::quantile(correlations, 0.5));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> found;
    for (std::size_t k = 0; k < windows.size(); ++k) {
      Guess guess = guesses[axis][k];
      guess.correlation = estimate.correlation;
      windows[k].improve(axis, true, guess);
      found.push_back(guess.log_noise / 2);
    }
    estimate.standard_deviation[axis] = std::exp(base::quantile(found, 0.5));
  }
  return estimate;
}

NoiseEstimate estimate_noise_model(const recording::Run& run, double gap_limit) {
  return estimate_noise_model(std::span(&run, 1), gap_limit);
}

}  // namespace millscope::trajectory
