// Units that cannot be meant are refused with the unit that is.
#include <catch2/catch.hpp>

#include <random>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

namespace {

/// The known motion in a mill of 0.24 m across; lengths and times multiplied.
std::string motion_rows(double length, double time) {
  const recording::Run seen = see(Motion(), {.duration = 20});
  std::string text;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    text += std::to_string(time * seen.time[i]);
    for (std::size_t k = 0; k < 3; ++k) text += " " + std::to_string(length * seen.position[k][i]);
    text += "\n";
  }
  return text;
}

std::string reason(const Scratch& scratch, double length, double time, const std::string& columns, const std::string& more = "") {
  scratch.file("run.txt", motion_rows(length, time));
  const auto yaml = scratch.file("r.yaml", "files: run.txt\ncolumns: " + columns + "\n" + more);
  return refusal([&] { recording::read_recording(yaml); });
}

}  // namespace

TEST_CASE("the right units pass") {
  const Scratch scratch;
  CHECK(reason(scratch, 1e3, 1e3, "{t: ms, x: mm, y: mm, z: mm}").empty());
  CHECK(reason(scratch, 1, 1, "{t: s, x: m, y: m, z: m}").empty());
  CHECK(reason(scratch, 1e2, 1e6, "{t: us, x: cm, y: cm, z: cm}").empty());
}

TEST_CASE("a mill of 240 m is refused, and mm are named") {
  const Scratch scratch;
  CHECK_THAT(reason(scratch, 1e3, 1e3, "{t: ms, x: m, y: m, z: m}"),
             Contains("r.yaml:2:") && Contains("no mill is that large") && Contains("x, y, z are probably in mm, not m"));
}

TEST_CASE("a mill of 0.24 mm is refused, and m are named") {
  const Scratch scratch;
  CHECK_THAT(reason(scratch, 1, 1e3, "{t: ms, x: mm, y: mm, z: mm}"),
             Contains("no mill is that small") && Contains("probably in m, not mm"));
}

TEST_CASE("beads faster than a fall across the mill can make them are refused, and the unit of time is named") {
  const Scratch scratch;
  CHECK_THAT(reason(scratch, 1e3, 1, "{t: ms, x: mm, y: mm, z: mm}"), Contains("faster than") && Contains("t is probably in s, not ms"));
  CHECK_THAT(reason(scratch, 1e3, 1e3, "{t: us, x: mm, y: mm, z: mm}"), Contains("faster than") && Contains("t is probably in ms, not us"));
}

TEST_CASE("milliseconds taken for seconds are refused") {
  const Scratch scratch;
  CHECK_THAT(reason(scratch, 1e3, 1e3, "{t: s, x: mm, y: mm, z: mm}"), Contains("apart") && Contains("t is probably in ms, not s"));
}

TEST_CASE("points that do not fit the stated mill are refused") {
  const Scratch scratch;
  CHECK_THAT(reason(scratch, 1e2, 1e3, "{t: ms, x: mm, y: mm, z: mm}", "condition: {mill_diameter: 3 m}\n"),
             Contains("the mill's diameter is 3 m"));
  CHECK_THAT(reason(scratch, 1e3, 1e3, "{t: ms, x: mm, y: mm, z: mm}", "condition: {mill_diameter: 30 mm}\n"),
             Contains("the mill's diameter is 0.03 m"));
}

TEST_CASE("a bare file in the wrong unit is refused as well") {
  const Scratch scratch;
  const auto file = scratch.file("run.csv", "t,x,y,z\n" + motion_rows(1, 1));
  CHECK(refusal([&] { recording::read_recording(file); }).empty() == false);
  const auto metres = scratch.file("metres.txt", "t_ms x_m y_m z_m\n" + motion_rows(1e3, 1e3));
  CHECK_THAT(refusal([&] { recording::read_recording(metres); }), Contains("metres.txt:") && Contains("probably in mm"));
}

TEST_CASE("a tracer at rest is a recording, however fast the camera") {
  const Scratch scratch;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0, 0.45);
  for (const double interval : {0.2, 4.0, 20.0}) {
    std::string text;
    for (int k = 0; k < 3000; ++k) {
      text += std::to_string(interval * k);
      for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(20 * axis + normal(generator));
      text += "\n";
    }
    INFO(interval << " ms");
    CHECK(recording::read_recording(scratch.file("rest.txt", text)).runs[0].size() > 2990);
  }
}
