// A known camera over a known path: what is estimated must be what was put in, within its own stated errors.
#include <unistd.h>

#include <fstream>

#include "millscope/observation_adapter.hpp"
#include "studies/camera/ctrack_writer.hpp"
#include "studies/camera/estimate_camera.hpp"
#include "studies/camera/estimate_parts.hpp"
#include "support.hpp"
#include "tests/skip.hpp"

using namespace camera_test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A bead that rides with the bed on circles about the axis and comes back through a falling layer, jostled on its way.
output::TrackSamples circulating(double seconds, std::uint64_t seed) {
  output::TrackSamples track;
  Random random(seed);
  const double step = 5e-4, omega = 6;
  double t = 0, radius = 0.12, along = 0.03, wander[3] = {0, 0, 0};
  while (t < seconds) {
    const double ride = 0.3 + 0.2 * random.uniform(), fall = 0.22, next = 0.05 + 0.09 * random.uniform();
    const double begin = -1.2, end = begin + omega * ride;
    for (double s = 0; s < ride + fall; s += step, t += step) {
      const bool rides = s < ride;
      const double share = rides ? 0 : (s - ride) / fall, smooth = share * share * (3 - 2 * share);
      const double angle = rides ? begin + omega * s : end + (begin - end) * smooth, r = radius + (next - radius) * smooth;
      const double speed = rides ? 0 : 0.02;  // m/s, of jostling in the falling layer, forgotten in 10 ms
      for (double& w : wander) w += -w * step / 0.01 + speed * std::sqrt(2 * step / 0.01) * random.normal();
      along += wander[2] * step;
      track.time.push_back(t);
      track.position[0].push_back(r * std::sin(angle) + 2e-3 * smooth * wander[0]);
      track.position[1].push_back(-r * std::cos(angle));
      track.position[2].push_back(along);
    }
    radius = next;
  }
  return track;
}

const char* const kKnown = R"(schema_version: 1
observations:
  blur: {kind: location_blur, window: 5 ms}
  rate: {kind: sampling, rate: 220 Hz}
  losses: {kind: error_cut, cut: 9 mm, spread: 4 mm, per_distance: 0.02, per_speed: 2 ms, scatter: 0.8 mm}
  noise: {kind: noise, white: [0.35, 0.35, 0.45, mm], correlated: [0.25, 0.25, 0.32, mm], correlation_time: 8 ms, growth: 8}
  gaps: {kind: gaps, rate: 0.2 Hz, mean_length: 0.8 s}
)";

recording::Recording seen(const std::string& camera, int runs) {
  recording::Recording recording;
  recording.file = "made here";
  const camera::Camera chain = camera::parse_camera(camera, "camera.yaml", registry());
  for (int k = 0; k < runs; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    recording.runs.push_back(camera::observe(circulating(40, 100 + number), chain, context_of(camera::bead_seed(3, k))));
    recording.runs.back().source = "made here";
  }
  recording.gap_limit = 0.1;
  recording.frame = recording::MillFrame{{0, 0}, 0, 0.06};
  return recording;
}

/// Within three standard errors, which must be small enough to say something.
void check(const char* what, const camera::Estimated& found, double truth, double largest_error) {
  INFO(what << ": " << found.value << " +- " << found.error << ", truth " << truth);
  CHECK(std::fabs(found.value - truth) <= 3 * found.error);
  CHECK(found.error <= largest_error);
}

}  // namespace

TEST_CASE("a known camera is found again within the stated errors") {
  const camera::CameraEstimate e = camera::estimate_camera(seen(kKnown, 3), {std::nullopt, 120});
  check("rate", e.sampling.rate, 220, 15);
  CHECK(e.sampling.dead_time == 0);
  check("evenness", e.sampling.shape, 1, 0.2);
  const double white[] = {3.5e-4, 3.5e-4, 4.5e-4}, correlated[] = {2.5e-4, 2.5e-4, 3.2e-4};
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    check("white", e.noise.white[axis], white[axis], 0.2e-3);
    check("correlated", e.noise.correlated[axis], correlated[axis], 0.2e-3);
    square += (white[axis] * white[axis] + correlated[axis] * correlated[axis]) / 3;
  }
  check("correlation time", e.noise.correlation_time, 8e-3, 8e-3);
  check("growth", e.noise.growth, 8, 6);
  check("noise near the middle", e.noise.total_near, std::sqrt(square) * (1 + 8 * e.noise.near), 0.15e-3);
  check("noise far from the middle", e.noise.total_far, std::sqrt(square) * (1 + 8 * e.noise.far), 0.2e-3);
  REQUIRE(e.loss.found);
  check("at rest", e.loss.at_rest, 6.25, 4);
  check("per distance", e.loss.per_distance, 25, 20);
  check("per speed", e.loss.per_speed, 2.5, 1.5);
  check("gap rate", e.gaps.rate, 0.2, 0.45);
  check("gap length", e.gaps.mean_length, 0.8, 0.5);
}

TEST_CASE("a bead of a slice is as far from the middle as its nearest image") {
  const camera::Middle slice{{0, 0, 0.03}, 0.06}, closed{{0, 0, 0.03}, 0};
  CHECK(slice.distance(0.03, 0.04, 0.03) == Approx(0.05));
  CHECK(slice.distance(0.03, 0.04, 0.03 + 7 * 0.06) == Approx(0.05));
  CHECK(slice.distance(0, 0, 0.03 - 2 * 0.06 + 0.02) == Approx(0.02));
  CHECK(slice.distance(0, 0, 0.06) == Approx(0.03));
  CHECK(closed.distance(0, 0, 0.15) == Approx(0.12));
}

TEST_CASE("in a slice that repeats along z noise depends on where the nearest image is") {
  recording::Recording slice;
  slice.file = "a slice";
  const camera::Camera chain = camera::parse_camera(kKnown, "camera.yaml", registry());
  for (int k = 0; k < 2; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    output::TrackSamples path = circulating(40, 100 + number);
    for (std::size_t i = 0; i < path.time.size(); ++i) path.position[2][i] += 0.02 * path.time[i];  // m: as far as thirteen lengths
    TrackContext context = context_of(camera::bead_seed(3, k));
    context.period = context.mill_high - context.mill_low;
    slice.runs.push_back(camera::observe(path, chain, context));
    slice.runs.back().source = "made here";
  }
  slice.gap_limit = 0.1;
  slice.frame = recording::MillFrame{{0, 0}, 0, 0};
  slice.condition.slice = recording::Slice{0, 0.06};
  const double square = (2 * (0.35 * 0.35 + 0.25 * 0.25) + 0.45 * 0.45 + 0.32 * 0.32) / 3 * 1e-6;
  const camera::CameraEstimate e = camera::estimate_camera(slice, {std::nullopt, 120});
  check("growth", e.noise.growth, 8, 6);
  check("noise near the middle", e.noise.total_near, std::sqrt(square) * (1 + 8 * e.noise.near), 0.15e-3);
  check("noise far from the middle", e.noise.total_far, std::sqrt(square) * (1 + 8 * e.noise.far), 0.2e-3);
  CHECK(e.noise.far < 0.2);
  // Without it, distances would be those along the path, which tell nothing.
  slice.condition.slice.reset();
  const camera::CameraEstimate unknowing = camera::estimate_camera(slice, {std::nullopt, 120});
  CHECK(unknowing.noise.far > 0.3);
  CHECK(unknowing.noise.growth.value < 2);
}

TEST_CASE("even intervals, a dead time and a camera without losses are recognised") {
  const camera::CameraEstimate e =
      camera::estimate_camera(seen("schema_version: 1\nobservations:\n  rate: {kind: sampling, rate: 200 Hz, dead_time: 2 ms, shape: 9}\n"
                                   "  noise: {kind: noise, white: [0.4, 0.4, 0.4, mm]}\n",
                                   1),
                              {std::nullopt, 60});
  check("rate", e.sampling.rate, 200, 6);
  check("evenness", e.sampling.shape, 9, 2);
  CHECK(std::fabs(e.sampling.dead_time - 2e-3) < 0.6e-3);
  CHECK_FALSE(e.loss.found);
  CHECK(e.gaps.count == 0);
  check("noise", e.noise.total_near, 0.4e-3, 0.1e-3);
}

TEST_CASE("where there is no slow noise, what chance makes of it is not told from none") {
  for (int k = 0; k < 4; ++k) {
    INFO("recording " << k);
    recording::Recording r = seen(
        "schema_version: 1\nobservations:\n  rate: {kind: sampling, rate: 200 Hz}\n  noise: {kind: noise, white: [0.4, 0.4, 0.4, mm]}\n",
        k + 1);
    r.runs = {r.runs.back()};
    const camera::CameraEstimate e = camera::estimate_camera(r, {std::nullopt, 60});
    check("noise", e.noise.total_near, 0.4e-3, 0.2e-3);
    CHECK(e.noise.correlated[0].value <= 3 * e.noise.correlated[0].error);
  }
}

TEST_CASE("the estimate as YAML is a camera file") {
  const camera::CameraEstimate e = camera::estimate_camera(seen(kKnown, 1), {std::nullopt, 40});
  const camera::Camera camera = camera::parse_camera(camera::camera_text(e, "made here"), "estimated.yaml", registry());
  std::vector<std::string> kinds;
  for (const camera::CameraLink& link : camera.links()) kinds.push_back(link.plugin.name());
  CHECK(kinds == std::vector<std::string>{"sampling", "error_cut", "noise", "gaps", "outliers", "frame_error"});
}

TEST_CASE("losses that the tracker's spread does not decide are a cut that can be written, and keep the same") {
  recording::Recording recording;
  recording::Run run;
  for (int i = 0; i < 400; ++i) {
    run.time.push_back(0.005 * i);
    for (auto& axis : run.position) axis.push_back(0.001 * (i % 50));
    run.spread.push_back(0.0005 + 0.00001 * (i % 100));  // 1 mm in the mean, at most 1.5 mm
  }
  recording.runs.push_back(run);
  for (const double at_rest : {1.2, 4.0}) {  // far above the margin of the fast beads in the windows: by the spreads u at rest is below 0
    camera::CameraLosses loss;
    loss.found = true, loss.typical_distance = 0.1;
    loss.at_rest.value = at_rest, loss.per_distance.value = 2, loss.per_speed.value = 3;
    camera::express_as_cut(loss, recording, {0, 0, 0}, {{0.1, 20, 0.05, 0.1, 0}, {0.1, 400, 0.05, (at_rest - 0.9) / 3, 1}});
    CHECK(loss.spread >= 0);
    CHECK(loss.scatter > 0);
    for (const double v : {0.0, 0.5, 1.5}) {
      const double margin = (loss.cut - loss.spread - loss.spread_per_distance * 0.05 - loss.spread_per_speed * v) / loss.scatter;
      CHECK(margin == Approx(at_rest - 2 * 0.05 - 3 * v).margin(1e-9));
    }
  }
}

TEST_CASE("that a camera loses fast beads is said where the recording shows it, against beads at rest") {
  camera::CameraLosses loss;
  loss.found = true, loss.typical_distance = 0.1;
  loss.at_rest.value = 1, loss.per_speed = {2, 0.5};
  // Phi(1) = 0.8413, Phi(1 - 2 0.5) = 0.5, Phi(1 - 2) = 0.1587
  CHECK(camera::losses_text(loss, 0.5) ==
        "its camera loses fast beads: of the locations that it keeps of a bead at rest it keeps 59 % at the shell's 0.5 m/s, 19 % at twice "
        "that");
  loss.per_speed.error = 1;
  CHECK(camera::losses_text(loss, 0.5).empty());
  loss.per_speed.error = 0.5;
  CHECK(camera::losses_text(loss, std::nan("")).empty());
  loss.found = false;
  CHECK(camera::losses_text(loss, 0.5).empty());
}

TEST_CASE("a recording that is too short says so") {
  recording::Recording recording = seen(kKnown, 1);
  recording::Run& run = recording.runs[0];
  run.time.resize(150);
  for (auto& x : run.position) x.resize(150);
  run.spread.clear();
  CHECK_THROWS_WITH(camera::estimate_camera(recording), Contains("150 locations are too few"));
}

TEST_CASE("a recording of short bursts says that it has no span to tell the rate from") {
  recording::Recording recording;
  recording.file = "bursts.a";
  recording::Run& run = recording.runs.emplace_back();
  Random random(5);
  for (int i = 0; i < 800; ++i) {
    const double t = 0.2 * (i / 8) + 1e-3 * (i % 8);
    run.time.push_back(t);
    const double at[3] = {0.1 * std::cos(3 * t), 0.1 * std::sin(3 * t), 0.03};
    for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(at[axis] + 3e-4 * random.normal());
  }
  recording.gap_limit = 0.01;
  CHECK_THROWS_WITH(camera::estimate_camera(recording), Contains("bursts.a: no 20 ms without a pause"));
}

TEST_CASE("an .a file reads back as it was written") {
  const recording::Run run = camera::observe(circulating(10, 1), camera::parse_camera(kKnown, "camera.yaml", registry()), context_of(5));
  const fs::path folder = fs::temp_directory_path() / fmt::format("camera_test_{}", getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "bead.a") << camera::ctrack_text(run);
  recording::Condition condition;
  condition.speed = 6;
  condition.angular_velocity = -6;
  condition.filling = 0.313;
  condition.bead_diameter = 0.01;
  condition.slice = recording::Slice{-0.017, 0.034};
  condition.power = recording::MeasuredPower{7.335, 0.003};
  std::ofstream(folder / "bead.yaml") << camera::recording_text({"bead.a"}, condition, "A test.");
  const recording::Recording back = recording::read_recording(folder / "bead.yaml");
  fs::remove_all(folder);
  REQUIRE(back.runs.size() == 1);
  REQUIRE(back.runs[0].size() + back.runs[0].report.outliers + back.runs[0].report.outside == run.size());
  CHECK(back.condition.angular_velocity == -6.0);
  CHECK(back.condition.filling == 0.313);
  REQUIRE(back.condition.slice);
  CHECK(back.condition.slice->low == -0.017);
  CHECK(back.condition.slice->high == 0.034);
  CHECK(back.condition.power->value == 7.335);
  std::size_t j = 0;
  for (std::size_t i = 0; i < back.runs[0].size(); ++i) {
    while (std::fabs(run.time[j] - back.runs[0].time[i]) > 1e-7) ++j;  // rows that the reader has set aside
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(std::fabs(run.position[axis][j] - back.runs[0].position[axis][i]) < 1e-6);
    CHECK(std::fabs(run.spread[j] - back.runs[0].spread[i]) < 1e-6);
  }
}

TEST_CASE("the camera of a known recording is found") {
  if (testing::absent("mill10_A_75_1.a")) return;
  const camera::CameraEstimate e = camera::estimate_camera(recording::read_recording(testing::recording("mill10_A_75_1.a")));
  CHECK(std::fabs(e.sampling.rate.value - 220) < 25);  // "about 220 locations/s before losses"
  CHECK(e.noise.total_near.value > 0.45e-3);           // "0.5 to 1 mm, growing with distance"
  CHECK(e.noise.total_near.value < 0.7e-3);
  CHECK(e.noise.total_far.value > 0.8e-3);
  CHECK(e.noise.total_far.value < 1.1e-3);
  CHECK(e.noise.growth.value > 3 * e.noise.growth.error);
  CHECK(e.noise.correlated[0].value > 3 * e.noise.correlated[0].error);
  CHECK(e.loss.found);
  CHECK(e.loss.kept(0.1, 0.2) > 0.9);
  CHECK(e.loss.kept(0.1, 2.0) < 0.5);  // "fast beads cut"
  CHECK(std::fabs(e.outliers.value - 1e-3) < 3 * e.outliers.error);
  REQUIRE(e.axis);
  check("axis x", (*e.axis)[0], 1.4e-3, 2e-3);
  check("axis y", (*e.axis)[1], -0.9e-3, 2e-3);
}
