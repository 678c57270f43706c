// Real recordings beside the sources, where there are any.
#include <catch2/catch.hpp>

#include "recording/support.hpp"
#include "studies/trajectory/trajectory.hpp"
#include "tests/skip.hpp"

using namespace millscope;
using namespace recording_test;
using testing::absent;

TEST_CASE("a real rotor recording: the cut last line and the points metres away are counted") {
  if (absent("rotor_calibration.a")) return;
  const recording::Recording recording = recording::read_recording(testing::recording("rotor_calibration.a"));
  REQUIRE(recording.runs.size() == 1);
  const recording::Run& run = recording.runs[0];
  CHECK(run.report.rows == 30611);
  CHECK(run.report.unreadable == 1);
  CHECK(run.report.outside + run.report.outliers + run.report.lost == 17);
  CHECK(run.report.lost == 2);  // one place three times, metres away, with a spread of 0
  CHECK(run.report.used == run.size());
  CHECK(run.report.gap_time == Approx(68.8).margin(0.1));
  for (const auto& component : run.position) {
    for (const double x : component) REQUIRE(std::fabs(x) < 0.15);
  }
  // The tracker's u is about 3 mm; the noise is a tenth of it (its README: 0.45 mm for a tracer at rest).
  const auto noise = trajectory::estimate_noise_model(run, recording.gap_limit).standard_deviation;
  for (const double each : noise) CHECK((each > 0.1e-3 && each < 0.45e-3));
}

TEST_CASE("a real mill recording: all points are used and its long gaps are found") {
  if (absent("uct_mill_part1.a")) return;
  const recording::Recording recording = recording::read_recording(testing::recording("uct_mill_part1.a"));
  const recording::Run& run = recording.runs[0];
  CHECK(run.report.rows == 16398);
  CHECK(run.report.unreadable == 0);
  CHECK(run.report.used > 16380);
  const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, {.gap_limit = 0.1});
  CHECK(trajectory.covered == Approx(96).margin(1));
  CHECK(trajectory.span == Approx(191.85).margin(0.1));
  for (const double each : trajectory.noise) CHECK((each > 0.4e-3 && each < 1.1e-3));
}

TEST_CASE("another code's recordings of one mill: five runs, duplicates, outliers, noise as stated") {
  if (absent("mill10_A_75_1.a")) return;
  const Scratch scratch;
  const recording::Recording recording = recording::read_recording(
      scratch.file("r.yaml", "files: \"" + testing::recording().string() + "mill10_A_75_?.a\"\nformat: ctrack\n"));
  REQUIRE(recording.runs.size() == 5);
  std::uint64_t rows = 0, dropped = 0, duplicates = 0;
  for (const recording::Run& run : recording.runs) {
    rows += run.report.rows;
    dropped += run.report.outliers + run.report.outside;
    duplicates += run.report.duplicates;
    for (const double each : trajectory::estimate_noise_model(run, recording.gap_limit).standard_deviation)
      CHECK((each > 0.5e-3 && each < 1e-3));  // its README: 0.5 to 1 mm
  }
  CHECK(rows == 32180);
  CHECK(duplicates > 100);
  CHECK(static_cast<double>(dropped) / static_cast<double>(rows) == Approx(1e-3).margin(0.5e-3));  // one in a thousand was put there
}

TEST_CASE("a gzipped recording") {
  if (absent("mill10_long/mill10_A_75_01.a.gz")) return;
  const recording::Recording recording = recording::read_recording(testing::recording("mill10_long/mill10_A_75_01.a.gz"));
  CHECK(recording.runs[0].name == "mill10_A_75_01");
  CHECK(recording.runs[0].report.rows == 3032);
}
