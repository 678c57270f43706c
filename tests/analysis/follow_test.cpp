// One road from runs of points to a source: what can be followed is, what cannot is named.
#include "studies/analysis/follow.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/support.hpp"
#include "studies/analysis/times.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;

namespace {

/// A bead on a circle, a point every 5 ms; `pause`: between all points, s, beyond every gap limit where it is large.
recording::Run circle(const std::string& name, std::size_t points, double pause = 0.005) {
  recording::Run run;
  run.name = name;
  run.source = name + ".a";
  for (std::size_t k = 0; k < points; ++k) {
    const double t = pause * static_cast<double>(k);
    run.time.push_back(t);
    run.position[0].push_back(0.05 * std::cos(4 * t));
    run.position[1].push_back(0.05 * std::sin(4 * t));
    run.position[2].push_back(0.02 + 0.01 * t);
  }
  return run;
}

recording::Recording recording_of(std::vector<recording::Run> runs) {
  recording::Recording recording;
  recording.file = "all.yaml";
  recording.runs = std::move(runs);
  recording.condition.bead_diameter = 0.004;
  recording.condition.tracer = {0.005, 2500};
  return recording;
}

trajectory::TrajectoryOptions steady() {
  trajectory::TrajectoryOptions options;
  options.noise.fill(1e-4);
  options.noise_correlation = 0;
  return options;
}

/// Every number of a source's blocks that the fits decide.
std::vector<double> numbers(analysis::FrameSource& source) {
  source.cut(0, 1);
  std::vector<double> all;
  const auto scratch = source.make_scratch();
  for (std::size_t c = 0; c < source.chunk_count(); ++c) {
    const FrameBlock& b = source.load(c, *scratch);
    for (std::int64_t f = 0; f < b.frame_count; ++f)
      all.insert(all.end(), {b.time[f], b.weight[f], b.position[0][f], b.position[2][f], b.velocity[1][f], b.position_variance[f],
                             b.radius[f], static_cast<double>(b.id[f])});
  }
  return all;
}

}  // namespace

TEST_CASE("runs that cannot be followed are left out and named with the reason, and take no other with them") {
  const recording::Recording recording =
      recording_of({circle("short", 3), circle("first", 400), circle("torn", 50, 1), circle("second", 300)});
  const analysis::Followed followed = analysis::follow(analysis::tracer_runs(recording, steady()), {.of = "all.yaml"});
  CHECK(followed.runs == std::vector<std::size_t>{1, 3});
  CHECK(followed.points == 700);
  CHECK(followed.source->survey().size() == 2);
  CHECK(followed.source->context().largest_id == 1);
  CHECK_THAT(followed.source->description(), Contains("all.yaml: 2 runs, 700 points, 3.4"));
  REQUIRE(followed.notes.size() == 1);
  CHECK_THAT(followed.notes[0], Contains("2 of 4 runs are left out: short.a: its 3 points"));
  CHECK_THAT(followed.notes[0], Contains("; torn.a: no trajectory: none of its 50 points"));
}

TEST_CASE("of many that cannot be followed the first are named and the others counted") {
  recording::Recording recording = recording_of({circle("whole", 400)});
  for (int k = 0; k < 9; ++k) recording.runs.push_back(circle("s" + std::to_string(k), 3));
  const analysis::Followed followed = analysis::follow(analysis::tracer_runs(recording, steady()), {.of = "all.yaml"});
  REQUIRE(followed.notes.size() == 1);
  CHECK_THAT(followed.notes[0], Contains("9 of 10 runs") && Contains("s2.a") && !Contains("s3.a") && Contains("and 6 more"));
}

TEST_CASE("a run that was asked for by name is not left out in silence") {
  const recording::Recording recording = recording_of({circle("first", 400), circle("short", 3)});
  CHECK_THAT(refusal([&] { analysis::follow(analysis::tracer_runs(recording, steady()), {.of = "all.yaml", .named = true}); }),
             Contains("short.a: its 3 points are too few") && Contains("asked for by name"));
}

TEST_CASE("where nothing can be followed it says why") {
  const recording::Recording two = recording_of({circle("short", 3), circle("torn", 50, 1)}), one = recording_of({circle("torn", 50, 1)});
  CHECK_THAT(refusal([&] { analysis::follow(analysis::tracer_runs(two, steady()), {.of = "all.yaml"}); }),
             Contains("all.yaml: none of its 2 runs can be followed; the first: short.a: its 3 points"));
  CHECK_THAT(refusal([&] { analysis::follow(analysis::tracer_runs(one, steady()), {.of = "all.yaml"}); }),
             Contains("torn.a: no trajectory"));
  trajectory::TrajectoryOptions wrong = steady();
  wrong.step = 0;
  CHECK_THAT(refusal([&] { analysis::follow(analysis::tracer_runs(recording_of({circle("a", 400)}), wrong), {.of = "all.yaml"}); }),
             Contains("step"));
}

TEST_CASE("threads change no bit of what is followed") {
  std::vector<recording::Run> runs;
  for (std::size_t k = 0; k < 7; ++k) runs.push_back(circle("r" + std::to_string(k), 200 + 50 * k));
  const recording::Recording recording = recording_of(std::move(runs));
  const std::vector<analysis::BeadRun> beads = analysis::tracer_runs(recording, steady());
  const std::vector<double> alone = numbers(*analysis::follow(beads, {.of = "all.yaml", .threads = 1}).source);
  CHECK(alone.size() > 1000);
  CHECK(numbers(*analysis::follow(beads, {.of = "all.yaml", .threads = 4}).source) == alone);
}

TEST_CASE("a tracer is of the size that is stated of it, and a bead keeps its own number") {
  const recording::Recording recording = recording_of({circle("a", 400)});
  std::vector<analysis::BeadRun> beads = analysis::tracer_runs(recording, steady());
  CHECK(beads[0].diameter == 0.005);
  CHECK(beads[0].density == 2500);
  beads[0].id = 41;
  CHECK(analysis::follow(beads, {.of = "all.yaml"}).source->context().largest_id == 41);
}
