// Paths, single observations and figures for the tests of the camera.
#pragma once

#include <fmt/core.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "studies/camera/camera.hpp"
#include "tests/plugins.hpp"

namespace camera_test {

using namespace millscope;

using testing::registry;

/// A chain of one link: chain_of("{kind: noise, …}").
inline camera::Camera chain_of(const std::string& link) {
  return camera::parse_camera("schema_version: 1\nobservations:\n  link: " + link + "\n", "camera.yaml", registry());
}

/// A bead at rest, sampled at `rate` for `seconds`.
inline output::TrackSamples resting(double seconds, double rate, std::array<double, 3> at = {0, 0, 0}) {
  output::TrackSamples track;
  const auto count = static_cast<std::size_t>(seconds * rate);
  for (std::size_t i = 0; i < count; ++i) {
    track.time.push_back(static_cast<double>(i) / rate);
    for (std::size_t axis = 0; axis < 3; ++axis) track.position[axis].push_back(at[axis]);
  }
  return track;
}

/// A bead on a circle about z.
inline output::TrackSamples circling(double seconds, double rate, double radius, double omega) {
  output::TrackSamples track = resting(seconds, rate, {0, 0, 0.03});
  for (std::size_t i = 0; i < track.size(); ++i) {
    track.position[0][i] = radius * std::cos(omega * track.time[i]);
    track.position[1][i] = radius * std::sin(omega * track.time[i]);
  }
  return track;
}

inline TrackContext context_of(std::uint64_t seed) { return {seed, 0.005, 0.15, 0.0, 0.06, -6.0, 0.0}; }

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

inline double deviation(const std::vector<double>& values) {
  const double m = mean(values);
  double sum = 0;
  for (const double v : values) sum += (v - m) * (v - m);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

inline std::vector<double> intervals(const recording::Run& run) {
  std::vector<double> result;
  for (std::size_t i = 1; i < run.size(); ++i) result.push_back(run.time[i] - run.time[i - 1]);
  return result;
}

}  // namespace camera_test
