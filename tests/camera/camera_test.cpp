// The chain: reading, refusing, repeating.
#include <thread>

#include "support.hpp"

using namespace camera_test;
using Catch::Contains;
using Catch::Matchers::WithinAbs;

namespace {

const char* const kWhole = R"(schema_version: 1
observations:
  blur: {kind: location_blur, window: 5 ms}
  rate: {kind: sampling, rate: 220 Hz}
  cut: {kind: error_cut, cut: 9 mm, spread: 4 mm, per_distance: 0.02, per_speed: 2 ms, scatter: 0.8 mm}
  noise: {kind: noise, white: [0.4, 0.4, 0.4, mm], correlated: [0.3, 0.3, 0.3, mm], correlation_time: 8 ms, growth: 5}
  gaps: {kind: gaps, rate: 0.5 Hz, mean_length: 0.2 s}
  far: {kind: outliers, fraction: 0.001}
  frame: {kind: frame_error, offset_x: 1.4 mm}
)";

camera::Camera parse(const std::string& text) { return camera::parse_camera(text, "camera.yaml", registry()); }

}  // namespace

TEST_CASE("a camera file is read strictly, with the place of what is wrong") {
  CHECK(parse(kWhole).links().size() == 7);
  CHECK(parse(kWhole).links()[1].name == "rate");
  CHECK(parse(kWhole).links()[1].plugin.name() == "sampling");
  const auto refused = [](const std::string& text, const std::string& what) { CHECK_THROWS_WITH(parse(text), Contains(what)); };
  const std::string head = "schema_version: 1\nobservations:\n";
  refused("observations: {}\n", "schema_version");
  refused("schema_version: 2\nobservations: {}\n", "camera.yaml:1");
  refused("schema_version: 1\n", "observations");
  refused("schema_version: 1\nobservation: {}\n", "did you mean 'observations'");
  refused(head + "  a: {rate: 3}\n", "kind");
  refused(head + "  a: {kind: nois}\n", "noise");
  refused(head + "  a: {kind: noise, wite: [1, 1, 1, mm]}\n", "did you mean 'white'");
  refused(head + "  a: {kind: noise, white: [1, 1, 1, s]}\n", "camera.yaml:3");
  refused(head + "  a: {kind: noise, white: [-1, 1, 1, mm]}\n", "camera.yaml:3");
  refused(head + "  a: {kind: sampling, rate: 300 Hz, dead_time: 5 ms}\n", "dead_time is 1 or more");
  refused(head + "  a: {kind: gravity}\n", "camera.yaml:3");
}

TEST_CASE("the same seed gives the same track, also from many threads, and another seed another") {
  const camera::Camera camera = parse(kWhole);
  const output::TrackSamples track = circling(10, 2000, 0.12, -6);
  const recording::Run first = camera::observe(track, camera, context_of(1));
  std::vector<recording::Run> again(4);
  std::vector<std::thread> threads;
  for (recording::Run& run : again) threads.emplace_back([&run, &camera, &track] { run = camera::observe(track, camera, context_of(1)); });
  for (std::thread& t : threads) t.join();
  for (const recording::Run& run : again) {
    CHECK(run.time == first.time);
    CHECK(run.position == first.position);
    CHECK(run.spread == first.spread);
  }
  CHECK(camera::observe(track, camera, context_of(2)).time != first.time);
  CHECK(camera::bead_seed(1, 4) != camera::bead_seed(1, 5));
  CHECK(camera::bead_seed(1, 4) != camera::bead_seed(2, 4));
}

TEST_CASE("taking one link away leaves the random numbers of the others") {
  const output::TrackSamples track = circling(10, 2000, 0.12, -6);
  const auto without = [&](const std::string& link) {
    std::string less = kWhole;
    const std::size_t at = less.find("  " + link + ":");
    REQUIRE(at != std::string::npos);
    less.erase(at, less.find('\n', at) - at + 1);
    return camera::observe(track, parse(less), context_of(1));
  };
  const recording::Run whole = camera::observe(track, parse(kWhole), context_of(1)), silent = without("noise");
  CHECK(silent.time == whole.time);
  CHECK(silent.spread == whole.spread);
  for (const std::string link : {"cut", "gaps"}) {  // what these had hidden is seen now, the rest as before
    const recording::Run more = without(link);
    INFO(link);
    CHECK(more.size() > whole.size());
    for (std::size_t i = 0, k = 0; i < whole.size(); ++i, ++k) {
      while (k < more.size() && more.time[k] < whole.time[i]) ++k;
      REQUIRE(k < more.size());
      REQUIRE(more.time[k] == whole.time[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) CHECK(more.position[axis][k] == whole.position[axis][i]);
    }
  }
}

TEST_CASE("an empty track stays empty, one sample passes") {
  CHECK(camera::observe({}, parse(kWhole), context_of(1)).size() == 0);
  CHECK(camera::observe(resting(0.01, 100), camera::Camera(), context_of(1)).size() == 1);
}

TEST_CASE("a path through a periodic box is continued") {
  output::TrackSamples track = resting(1, 100);
  std::vector<double> truth;
  for (std::size_t i = 0; i < track.size(); ++i) {
    truth.push_back(0.01 + 0.05 * std::sin(0.2 * static_cast<double>(i)));
    track.position[2][i] = truth.back() - 0.04 * std::floor(truth.back() / 0.04);
  }
  output::unwrap(track.position[2], 0.04);
  const double shift = track.position[2][0] - truth[0];
  for (std::size_t i = 0; i < truth.size(); ++i) CHECK_THAT(track.position[2][i] - truth[i], WithinAbs(shift, 1e-12));
}
