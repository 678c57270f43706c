// What the tests of analyses share: a scratch directory, a made-up simulation, analyzers that live in the test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "millscope/analyzer_adapter.hpp"
#include "millscope/observation_adapter.hpp"
#include "studies/analysis/instances.hpp"
#include "tests/plugins.hpp"
#include "tests/scratch.hpp"

namespace analysis_test {

namespace fs = std::filesystem;
using namespace millscope;
using testing::refusal;
using testing::Scratch;

inline void spill(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// Beads on circles about the axis of a drum of 0.1 m radius and 0.05 m length, turning with it at 2 rad/s (clockwise), each at a radius
/// of its own; the walls do work at 0.3 W. Frames every 10 ms from 1 s on; tracks at 2 kHz of beads 0 and 3, which move along z through
/// the periodic border.
struct Drum {
  std::size_t beads = 6, frames = 200;
  double omega = -2, power = 0.3, step = 0.01, start = 1, track_seconds = 4;
  bool at_rest_first = false;  ///< the first frame says Ω = 0: it starts to turn at that moment
  double radius(std::size_t bead) const { return 0.02 + 0.01 * static_cast<double>(bead); }
  double angle(std::size_t bead, double time) const { return static_cast<double>(bead) + omega * time; }
  double z(std::size_t bead, double time) const { return 0.01 * static_cast<double>(bead) + 0.02 * time; }  ///< before it is wrapped

  void write_case(const fs::path& directory) const;
  void write_frames(const fs::path& directory) const;
  void write_tracks(const fs::path& directory) const;
  /// All three.
  void write(const fs::path& directory) const;
};

/// An instance of an analyzer of the test itself; A as `describe` wants it.
template <class A>
analysis::AnalyzerInstance local_instance(const std::string& name, const AnalyzerContext& context) {
  static constexpr Descriptor descriptor = describe<A>({.name = "local"});
  const config::ResolvedValues values;
  const host::Loaded loaded{&descriptor, nullptr};
  return {name, host::AnalyzerObject::create(loaded, values.view(), base::Location{}, context), values};
}

/// x_i = φ x_{i−1} + √(1 − φ²) ε_i: variance 1, integrated autocorrelation time ½ (1 + φ)/(1 − φ) steps.
inline std::vector<double> autoregressive(std::size_t count, double phi, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> x(count);
  double value = random.normal();
  for (double& at : x) {
    at = value;
    value = phi * value + std::sqrt(1 - phi * phi) * random.normal();
  }
  return x;
}

}  // namespace analysis_test
