// Gaps, dead time and evenness from the intervals between locations.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/camera/estimate_parts.hpp"

namespace millscope::studies::camera {
namespace {

std::vector<double> intervals_of(const Recording& recording) {
  std::vector<double> result;
  for (const Run& run : recording.runs) {
    for (std::size_t i = 1; i < run.size(); ++i) result.push_back(run.time[i] - run.time[i - 1]);
  }
  return result;
}

/// The step in which the file writes its times: the least difference between intervals that rounding of doubles does not make.
double resolution_of(std::vector<double> intervals) {
  std::sort(intervals.begin(), intervals.end());
  double least = intervals.empty() ? 0.0 : intervals.front();
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    const double difference = intervals[i] - intervals[i - 1];
    if (difference > 1e-8) least = std::min(least, difference);
  }
  return least;
}

/// Square of the coefficient of variation.
double variation(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double sum = 0, squares = 0;
  for (std::size_t i = from; i < to; ++i) {
    sum += values[i];
    squares += values[i] * values[i];
  }
  const double n = static_cast<double>(to - from), mean = sum / n;
  return (squares / n - mean * mean) / (mean * mean) * n / (n - 1);
}

}  // namespace

CameraGaps estimate_gaps(const Recording& recording, double limit) {
  CameraGaps gaps;
  gaps.limit = limit;
  double live = 0, beyond = 0;
  for (const double d : intervals_of(recording)) {
    if (d <= limit) {
      live += d;
      continue;
    }
    beyond += d - limit;
    ++gaps.count;
  }
  if (gaps.count == 0) {
    gaps.rate = {0, 3 / std::max(live, 1e-9)};  // none in this time: 95 % sure below 3 per live time
    return gaps;
  }
  // Exponential lengths have no memory: what lies beyond the limit has the mean of the whole.
  const double n = static_cast<double>(gaps.count), length = beyond / n, hidden = std::exp(limit / length);
  gaps.mean_length = {length, length / std::sqrt(n)};
  gaps.rate = {n / live * hidden, n / live * hidden / std::sqrt(n) * (1 + limit / length)};
  return gaps;
}

void estimate_intervals(CameraSampling& sampling, const Recording& recording, const RateModel& model, double pause) {
  std::vector<double> all;
  for (const double d : intervals_of(recording)) {
    if (d <= pause) all.push_back(d);
  }
  const double resolution = resolution_of(all);
  const double shortest = *std::min_element(all.begin(), all.end());
  // Chance alone keeps the shortest of n Poisson intervals 1/(n λ) above zero.
  const double chance = 3 / (model.rate.value * static_cast<double>(all.size()));
  sampling.dead_time = shortest - resolution > chance ? shortest - resolution : 0.0;
  // Losing a share 1 − p of the locations turns intervals of variation r into sums of a geometric number of them:
  // variation = p r + 1 − p. The mean rate of loss stands for all intervals: taken where it is small, over tenths of the recording.
  const double p = std::min(1.0, static_cast<double>(all.size()) / std::accumulate(all.begin(), all.end(), 0.0) / model.rate.value);
  const double sight = 1 - model.rate.value * sampling.dead_time;
  constexpr std::size_t kParts = 10;
  std::vector<double> shapes;
  for (std::size_t part = 0; part < kParts; ++part) {
    const double r = (variation(all, part * all.size() / kParts, (part + 1) * all.size() / kParts) - (1 - p)) / p;
    shapes.push_back(r > 0 ? sight * sight / r : 1e3);
  }
  double mean = 0, square = 0;
  for (const double s : shapes) mean += s / kParts;
  for (const double s : shapes) square += (s - mean) * (s - mean) / (kParts - 1);
  sampling.shape = {std::max(mean, 1.0), std::sqrt(square / kParts)};
}

}  // namespace millscope::studies::camera
