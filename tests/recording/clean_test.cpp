// Points that cannot be, and gaps.
#include <catch2/catch.hpp>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;

namespace {

std::string moved(const std::string& row, const std::string& x) {
  const std::size_t first = row.find(' '), second = row.find(' ', first + 1);
  return row.substr(0, first + 1) + x + row.substr(second);
}

}  // namespace

TEST_CASE("points metres away are outside, and all other points stay") {
  const Scratch scratch;
  const std::string text =
      circle_rows(1000, [](int k, std::string row) { return k == 300 || k == 301 || k == 700 ? moved(row, "-1376.3") : row; });
  const recording::Run run = recording::read_recording(scratch.file("far.txt", text)).runs[0];
  CHECK(run.report.outside == 3);
  CHECK(run.report.outliers == 0);
  CHECK(run.size() == 997);
}

TEST_CASE("points that no bead can reach and leave again are outliers, alone and in groups") {
  const Scratch scratch;
  const std::string text = circle_rows(1000, [](int k, std::string row) {
    if (k == 200 || (k >= 500 && k < 507)) return moved(row, "-20.0");
    return row;
  });
  // At k = 200 the bead is at x = −65 mm, at k = 500 at −84 mm: 45 and 64 mm in 5 ms are 9 and 13 m/s.
  const recording::Run run = recording::read_recording(scratch.file("jumps.txt", text)).runs[0];
  CHECK(run.report.outliers == 8);
  CHECK(run.size() == 992);
}

TEST_CASE("the fastest that a bead can be is no outlier") {
  const Scratch scratch;
  const Motion motion;
  const recording::Run seen = see(motion, {.duration = 30});
  std::string text = "t x y z\n";
  for (std::size_t i = 0; i < seen.size(); ++i) {
    text += std::to_string(1e3 * seen.time[i]) + " " + std::to_string(1e3 * seen.position[0][i]) + " " +
            std::to_string(1e3 * seen.position[1][i]) + " " + std::to_string(1e3 * seen.position[2][i]) + "\n";
  }
  const recording::Run run = recording::read_recording(scratch.file("fast.txt", text)).runs[0];
  CHECK(run.report.outliers == 0);
  CHECK(run.report.outside == 0);
  CHECK(run.size() == seen.size());
}

TEST_CASE("a bead that really was elsewhere is kept: both sides of a long jump stay") {
  const Scratch scratch;
  const std::string text = circle_rows(1000, [](int k, std::string row) { return k >= 400 && k < 600 ? moved(row, "40.0") : row; });
  const recording::Run run = recording::read_recording(scratch.file("elsewhere.txt", text)).runs[0];
  CHECK(run.size() >= 980);  // at most ten points go at each jump
}

TEST_CASE("the mill and its place narrow what is outside") {
  const Scratch scratch;
  scratch.file("run.txt",
               circle_rows(1000, [](int k, std::string row) { return k == 500 ? row.substr(0, row.rfind(' ')) + " 75.0" : row; }));
  const auto outside = [&](const std::string& more) {
    return recording::read_recording(scratch.file("r.yaml", "files: run.txt\n" + more)).runs[0].report.outside;
  };
  CHECK(outside("") == 0);  // 45 mm along z is nothing against 200 mm across
  CHECK(outside("condition: {mill_diameter: 220 mm}\nframe: {axis: [0, 0], ends: [0, 60 mm]}\n") == 1);
}

TEST_CASE("gaps are counted against a limit that follows the rate, or that is given") {
  const Scratch scratch;
  std::string text;
  for (int k = 0; k < 1000; ++k) {
    if (k >= 300 && k < 320) continue;  // a pause of 105 ms
    if (k >= 600 && k < 604) continue;  // of 25 ms
    text += circle_row(k) + "\n";
  }
  scratch.file("run.txt", text);
  const recording::Recording own = recording::read_recording(scratch / "run.txt");
  CHECK(own.gap_limit == Approx(0.05));  // ten intervals of 5 ms
  CHECK(own.runs[0].report.gaps == 1);
  CHECK(own.runs[0].report.gap_time == Approx(0.105));
  const recording::Recording given = recording::read_recording(scratch.file("r.yaml", "files: run.txt\ngap_limit: 20 ms\n"));
  CHECK(given.gap_limit == 0.02);
  CHECK(given.runs[0].report.gaps == 2);
  CHECK(given.runs[0].report.gap_time == Approx(0.13));
}

TEST_CASE("every row is in exactly one of the counts") {
  const Scratch scratch;
  std::string text = circle_rows(2000, [](int k, std::string row) {
    if (k % 97 == 5) return std::string("12 words");
    if (k % 89 == 7) return row + "\n" + row;
    if (k % 83 == 9) return moved(row, "nan");
    if (k % 79 == 11) return moved(row, "5000");
    if (k % 211 == 13) return "9e9" + row.substr(row.find(' '));
    return row;
  });
  const recording::RunReport r = recording::read_recording(scratch.file("all.txt", text)).runs[0].report;
  CHECK(r.rows == r.used + r.unreadable + r.not_finite + r.false_times + r.duplicates + r.outliers + r.outside);
  CHECK(r.unreadable == 21);
  CHECK(r.false_times > 0);
  CHECK(r.duplicates > 0);
}
