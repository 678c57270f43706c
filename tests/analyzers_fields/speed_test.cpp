// Not run with the others: `make figures` prints how fast each analyzer takes frames of the study's whole mill.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

TEST_CASE("speed on 58 000 beads", "[.speed]") {
  constexpr std::int64_t kBeads = 58000;
  constexpr int kFrames = 30, kRepeats = 3;
  const Frames frames = all_beads(turning_disc(kBeads, 0.15, 5), kBeads, even_times(kFrames, 0.01), std::vector<double>(kFrames, 0.01), 5);
  double all = 0;
  for (const char* name : {"pept_grid", "distributions", "power", "models", "slip"}) {
    const Analyzer analyzer(name, study());
    Sums sums = analyzer.zero();
    analyzer.add(frames.block(), sums);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRepeats; ++i) analyzer.add(frames.block(), sums);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / (kRepeats * kFrames * kBeads);
    all += seconds;
    std::printf("%-14s %6.1f ns per bead and frame, %6.0f MB/s of frames of 36 B a bead, one thread\n", name, 1e9 * seconds,
                36e-6 / seconds);
  }
  std::printf("%-14s %6.1f ns per bead and frame, %6.0f MB/s\n", "all of them", 1e9 * all, 36e-6 / all);
  CHECK(36e-6 / all > 200);
}
