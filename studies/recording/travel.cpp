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

std::vector<double> places_of(std::span<const Run> runs, std::size_t axis) {
  const std::size_t stride = stride_of(runs);
  std::vector<double> values;
  for (const Run& run : runs) {
    for (std::size_t i = 0; i < run.size(); i += stride) values.push_back(run.position[axis][i]);
  }
  return values;
}

/// From the 2nd to the 98th percentile; 0 of nothing.
double width_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  const double low = base::quantile(values, 0.02), high = base::quantile(values, 0.98);
  return high - low;
}

double largest(const std::array<double, 3>& values) { return std::max({values[0], values[1], values[2]}); }

/// `noises`: of each run, the largest component.
double speed_quantile(std::span<const Run> runs, double fraction, const std::vector<double>& noises) {
  constexpr std::size_t kSteps = 5;
  constexpr double kNoises = 5;  // taken off the way, lest a bead at rest looks fast to a quick camera
  const std::size_t stride = stride_of(runs);
  std::vector<double> speeds;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Run& run = runs[r];
    for (std::size_t i = 0; i + kSteps < run.size(); i += stride) {
      double squared = 0;
      for (const auto& component : run.position) squared += std::pow(component[i + kSteps] - component[i], 2);
      speeds.push_back(std::max(0.0, std::sqrt(squared) - kNoises * noises[r]) / (run.time[i + kSteps] - run.time[i]));
    }
  }
  return speeds.empty() ? 0 : base::quantile(speeds, fraction);
}

}  // namespace

double Extent::largest() const { return std::max({width[0], width[1], width[2]}); }
double Extent::across() const { return std::max(width[0], width[1]); }

Extent measure_extent(std::span<const Run> runs) {
  Extent extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values = places_of(runs, axis);
    if (values.empty()) continue;
    extent.width[axis] = width_of(values);
    extent.middle[axis] = base::quantile(values, 0.5);
  }
  return extent;
}

double speed_quantile(std::span<const Run> runs, double fraction) {
  std::vector<double> noises;
  for (const Run& run : runs) noises.push_back(largest(difference_noise(run, std::numeric_limits<double>::infinity())));
  return speed_quantile(runs, fraction, noises);
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
  std::vector<double> noises;
  for (const Run& run : runs) {
    const DifferenceNoises noise = difference_noises(run, gap_limit);
    noises.push_back(largest(noise.all));
    travel.noise = std::max(travel.noise, largest(noise.unbroken));
  }
  std::array<std::vector<double>, 2> places{places_of(runs, 0), places_of(runs, 1)};
  const double across = std::max(width_of(places[0]), width_of(places[1]));
  travel.speed = 1.5 * std::max(fall_speed(across), 1.5 * speed_quantile(runs, 0.95, noises));
  return travel;
}

}  // namespace millscope::recording
