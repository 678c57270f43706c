// Small recordings written by the tests, and a motion that is known.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/recording/recording.hpp"
#include "tests/scratch.hpp"

namespace recording_test {

using testing::refusal;

/// A folder of its own with files in it.
struct Scratch : testing::Scratch {
  /// Writes a file and returns its path.
  std::filesystem::path file(const std::string& name, const std::string& text) const;
  std::filesystem::path packed(const std::string& name, const std::string& text) const;  ///< gzipped
};

/// A bead in a mill of 0.3 m that turns with Ω = 6 rad/s: it rides on a circle of 0.12 m, leaves at 60° above the horizontal, flies a
/// parabola, strikes the circle and rides again. Along z it drifts, and each impact changes the drift.
struct Motion {
  static constexpr double kRadius = 0.12, kOmega = 6, kGravity = 9.81;
  Motion();
  std::array<double, 3> position(double t) const;
  std::array<double, 3> velocity(double t) const;
  double period() const { return ride_ + flight_; }
  bool flies(double t) const;

 private:
  std::array<double, 6> state(double t) const;
  double landing_ = 0, ride_ = 0, flight_ = 0;  // angle, s, s
};

/// What a camera sees of a motion.
struct Camera {
  double rate = 220;       ///< points per second, at random times
  double noise = 0.7e-3;   ///< m
  double correlation = 0;  ///< of the noise from point to point
  double duration = 20;    ///< s
  std::uint64_t seed = 1;
  double grid = 1e-4;  ///< s, to which times are rounded
};
millscope::recording::Run see(const Motion& motion, const Camera& camera);

/// The nine lines above the rows of an `.a` file.
std::string ctrack_head();
/// A row of an `.a` file: ms, mm.
std::string ctrack_row(double time, double x, double y, double z, double u = 3);
/// A slow circle of 100 mm: rows t (ms), x, y, z (mm) every 5 ms, of which `change` may alter the text.
std::string circle_rows(int count, const std::function<std::string(int, std::string)>& change = {});
std::string circle_row(int k, const char* separator = " ");

}  // namespace recording_test
