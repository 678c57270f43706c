#include "studies/recording/travel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/statistics.hpp"
#include "studies/recording/noise.hpp"

namespace millscope::recording {
namespace {

constexpr double kGravity = 9.81;       // m/s²
constexpr std::size_t kSample = 50000;  // points that a percentile is taken from

std::size_t stride_of(std::span<const Run> runs) {
  std::size_t total = 0;
  for (const Run& run : runs) total += run.size();
  return total / kSample + 1;
}

}  // namespace

double Extent::largest() const { return std::max({width[0], width[1], width[2]}); }
double Extent::across() const { return std::max(width[0], width[1]); }

Extent measure_extent(std::span<const Run> runs) {
  const std::size_t stride = stride_of(runs);
  Extent extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Run& run : runs) {
      for (std::size_t i = 0; i < run.size(); i += stride) values.push_back(run.position[axis][i]);
    }
    if (values.empty()) continue;
    const double low = base::quantile(values, 0.02), high = base::quantile(values, 0.98);
    extent.middle[axis] = base::quantile(values, 0.5);
    extent.width[axis] = high - low;
  }
  return extent;
}

double speed_quantile(std::span<const Run> runs, double fraction) {
  constexpr std::size_t kSteps = 5;
  constexpr double kNoises = 5;  // taken off the way, lest a bead at rest looks fast to a quick camera
  const std::size_t stride = stride_of(runs);
  std::vector<double> speeds;
  for (const Run& run : runs) {
    const auto components = difference_noise(run, std::numeric_limits<double>::infinity());
    const double noise = std::max({components[0], components[1], components[2]});
    for (std::size_t i = 0; i + kSteps < run.size(); i += stride) {
      double squared = 0;
      for (const auto& component : run.position) squared += std::pow(component[i + kSteps] - component[i], 2);
      speeds.push_back(std::max(0.0, std::sqrt(squared) - kNoises * noise) / (run.time[i + kSteps] - run.time[i]));
    }
  }
  return speeds.empty() ? 0 : base::quantile(speeds, fraction);
}

double fall_speed(double diameter) { return std::sqrt(2 * kGravity * diameter); }

bool Travel::possible(const Run& run, std::size_t i, std::size_t j) const {
  constexpr double kNoises = 7;
  const double reach = speed * (run.time[j] - run.time[i]) + kNoises * noise;
  const double dx = run.position[0][j] - run.position[0][i], dy = run.position[1][j] - run.position[1][i],
               dz = run.position[2][j] - run.position[2][i];
  return dx * dx + dy * dy + dz * dz <= reach * reach;
}

Travel measure_travel(std::span<const Run> runs, double gap_limit) {
  Travel travel;
  travel.speed = 1.5 * std::max(fall_speed(measure_extent(runs).across()), 1.5 * speed_quantile(runs, 0.95));
  for (const Run& run : runs) {
    for (const double noise : difference_noise(run, gap_limit)) travel.noise = std::max(travel.noise, noise);
  }
  return travel;
}

}  // namespace millscope::recording
