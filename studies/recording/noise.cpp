#include "studies/recording/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/base/statistics.hpp"

namespace millscope::recording {
namespace {

using Contrasts = std::array<std::vector<double>, 3>;

/// The contrasts are left in another order.
std::array<double, 3> noise_of(Contrasts& contrasts) {
  constexpr double kMedianOfNormal = 0.6744897501960817;  // median of |z| for a standard normal z
  std::array<double, 3> noise{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    noise[axis] = contrasts[axis].empty() ? 0 : base::quantile(contrasts[axis], 0.5) / kMedianOfNormal;
  return noise;
}

/// All of a run; `across`: whether each lies across a gap.
Contrasts contrasts_of(const Run& run, double gap_limit, std::vector<char>& across) {
  Contrasts contrasts;
  const std::size_t stride = run.size() / 50000 + 1;
  for (std::size_t i = 0; i + 3 < run.size(); i += stride) {
    const double* t = run.time.data() + i;
    across.push_back(static_cast<char>(t[1] - t[0] > gap_limit || t[2] - t[1] > gap_limit || t[3] - t[2] > gap_limit));
    std::array<double, 4> weight{};
    double norm = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      double product = 1;
      for (std::size_t k = 0; k < 4; ++k) product *= j == k ? 1 : t[j] - t[k];
      weight[j] = 1 / product;
      norm += weight[j] * weight[j];
    }
    norm = std::sqrt(norm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* x = run.position[axis].data() + i;
      contrasts[axis].push_back(std::fabs(weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2] + weight[3] * x[3]) / norm);
    }
  }
  return contrasts;
}

}  // namespace

DifferenceNoises difference_noises(const Run& run, double gap_limit) {
  std::vector<char> across;
  Contrasts contrasts = contrasts_of(run, gap_limit, across);
  const bool broken = std::any_of(across.begin(), across.end(), [](char c) { return c != 0; });
  Contrasts unbroken;
  for (std::size_t axis = 0; broken && axis < 3; ++axis) {
    for (std::size_t i = 0; i < across.size(); ++i) {
      if (across[i] == 0) unbroken[axis].push_back(contrasts[axis][i]);
    }
  }
  DifferenceNoises noises;
  noises.all = noise_of(contrasts);
  noises.unbroken = broken ? noise_of(unbroken) : noises.all;
  return noises;
}

std::array<double, 3> difference_noise(const Run& run, double gap_limit) { return difference_noises(run, gap_limit).unbroken; }

}  // namespace millscope::recording
