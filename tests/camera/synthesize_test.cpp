// A directory as a run leaves it, seen by a camera: files that read back as a recording of that mill.
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/output/tracks.hpp"
#include "studies/camera/ctrack_writer.hpp"
#include "studies/camera/estimate_camera.hpp"
#include "studies/camera/synthesize.hpp"
#include "support.hpp"

using namespace camera_test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr double kPeriod = 0.032;  // m, of the case

/// A run of two beads for six seconds; the case analyses from 2 s on. The beads wander along the periodic axis.
class RunDirectory {
 public:
  RunDirectory() : path_(fs::temp_directory_path() / fmt::format("camera_run_{}", getpid())) {
    fs::create_directories(path_);
    std::ofstream(path_ / "case.resolved.yaml")
        << "schema_version: 1\ninclude: [" << MILLSCOPE_SOURCE_DIR << "/configs/ergodicity/slice_60s.yaml]\n";
    std::ofstream(path_ / "summary.json") << R"({"power_W": {"com": 3.77, "com_sem": 0.01}})";
    const std::vector<output::TrackInfo> infos = {{"bead_7", 7, 0.01, 2500, "simulation"}, {"bead_9", 9, 0.01, 2500, "simulation"}};
    auto writer = output::TrackWriter::create(path_ / "tracks.h5", infos);
    for (int i = 0; i <= 12000; ++i) {
      const double t = 5e-4 * i, along = 0.01 * t;
      std::vector<double> row;
      for (const double radius : {0.1, 0.13})
        row.insert(row.end(), {radius * std::sin(6 * t), -radius * std::cos(6 * t), std::fmod(along, kPeriod)});
      writer.append(t, row);
    }
    writer.close();
  }
  ~RunDirectory() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

camera::SynthesisRequest request_to(const fs::path& file) {
  camera::SynthesisRequest request;
  request.file = file;
  return request;
}

}  // namespace

TEST_CASE("simulated beads become a recording of their mill") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  const camera::Camera camera = chain_of("{kind: sampling, rate: 200 Hz}");
  const camera::Synthesis done = camera::synthesize(beads, camera, request_to(run.path() / "seen.a"));
  CHECK(done.files == std::vector<fs::path>{run.path() / "seen_1.a", run.path() / "seen_2.a"});
  CHECK(done.notes.empty());
  CHECK(done.seconds == Approx(8));
  const recording::Recording back = recording::read_recording(done.recording);
  REQUIRE(back.runs.size() == 2);
  CHECK(back.condition.angular_velocity == Approx(6.1692).epsilon(1e-4));
  CHECK(back.condition.filling == 0.313);
  CHECK(back.condition.bead_diameter == 0.01);
  CHECK(back.condition.mill_diameter == 0.3);
  CHECK(back.condition.power->value == 3.77);
  CHECK_FALSE(back.condition.mill_length);  // a periodic slice has no length
  REQUIRE(back.condition.slice);
  CHECK(back.condition.slice->length() == Approx(kPeriod));
  for (std::size_t k = 0; k < 2; ++k) {
    const recording::Run& seen = back.runs[k];
    CHECK(seen.size() > 700);
    CHECK(seen.time.front() >= 2);
    const double first = seen.position[2].front(), last = seen.position[2].back();
    CHECK(last - first == Approx(0.01 * (seen.time.back() - seen.time.front())).epsilon(1e-3));  // the path goes on across the border
    for (std::size_t i = 0; i < seen.size(); i += 100) {
      CHECK(std::hypot(seen.position[0][i], seen.position[1][i]) == Approx(k == 0 ? 0.1 : 0.13).epsilon(1e-4));
    }
  }
}

TEST_CASE("a camera follows a bead of a slice through the images") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  CHECK(beads.context(0, 1).period == Approx(kPeriod));
  const output::TrackSamples path = beads.path(0, 2);
  CHECK(path.position[2].back() - path.position[2].front() > kPeriod);
  const recording::Run seen =
      camera::observe(path, chain_of("{kind: error_cut, cut: 20 mm, spread: 4 mm, per_distance: 0.1, scatter: 0}"), beads.context(0, 1));
  CHECK(seen.size() == path.size());  // 4 mm + 0.1 · 101 mm; from the mill's middle alone 4 mm + 0.1 · 175 mm at the end
}

TEST_CASE("where one file is in the way none is written") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  for (const char* name : {"seen_2.a", "seen.yaml"}) {
    std::ofstream(run.path() / name) << "mine";
    CHECK_THROWS_WITH(camera::synthesize(beads, camera::Camera(), request_to(run.path() / "seen.a")),
                      Contains(name) && Contains("exists already"));
    CHECK_FALSE(fs::exists(run.path() / "seen_1.a"));
    fs::remove(run.path() / name);
  }
  CHECK(camera::synthesis_targets(beads, request_to(run.path() / "seen.a")) ==
        std::vector<fs::path>{run.path() / "seen_1.a", run.path() / "seen_2.a", run.path() / "seen.yaml"});
}

TEST_CASE("one bead gives one file, the same seed the same bytes, and nothing is overwritten unasked") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  const camera::Camera camera = chain_of("{kind: noise, white: [1, 1, 1, mm]}");
  camera::SynthesisRequest request = request_to(run.path() / "seen.a");
  request.beads = {9};
  const auto bytes = [&] {
    std::ifstream in(run.path() / "seen.a");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  CHECK(camera::synthesize(beads, camera, request).files == std::vector<fs::path>{run.path() / "seen.a"});
  const std::string first = bytes();
  CHECK_THROWS_WITH(camera::synthesize(beads, camera, request), Contains("exists already"));
  request.overwrite = true;
  camera::synthesize(beads, camera, request);
  CHECK(bytes() == first);
  request.seed = 2;
  camera::synthesize(beads, camera, request);
  CHECK(bytes() != first);
}

TEST_CASE("what cannot be synthesized says why") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  camera::SynthesisRequest request = request_to(run.path() / "seen.a");
  request.beads = {8};
  CHECK_THROWS_WITH(camera::synthesize(beads, camera::Camera(), request), Contains("--bead 8") && Contains("7, 9"));
  request.beads = {};
  request.from = 7;
  CHECK_THROWS_WITH(camera::synthesize(beads, camera::Camera(), request), Contains("no sample after 7 s"));
  request.from = 0;
  CHECK_THROWS_WITH(camera::synthesize(beads, chain_of("{kind: error_cut, cut: 1 mm, spread: 5 mm}"), request), Contains("saw nothing"));
  CHECK_FALSE(fs::exists(run.path() / "seen_1.a"));
  CHECK_THROWS_WITH(camera::SimulatedBeads(run.path() / "nowhere", registry()), Contains("no directory of a run"));
  fs::remove(run.path() / "tracks.h5");
  CHECK_THROWS_WITH(camera::SimulatedBeads(run.path(), registry()), Contains("output.tracks.beads"));
}

TEST_CASE("points that no file holds are treated as if they were read from one") {
  const RunDirectory run;
  const camera::SimulatedBeads beads(run.path(), registry());
  const camera::Camera camera = chain_of("{kind: sampling, rate: 400 Hz}").before(chain_of("{kind: noise, white: [0.4, 0.4, 0.4, mm]}"));
  recording::Recording given;
  given.file = run.path() / "seen.yaml";
  given.condition.mill_diameter = 0.3;
  given.frame = recording::MillFrame{};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 2; ++i) {
    recording::Run seen = camera::observe(beads.path(i, 2), camera, beads.context(i, 5));
    for (std::size_t k = 0; k < seen.size(); ++k)
      seen.spread.push_back(0.003 - 1.3137e-6 * static_cast<double>(k));  // decides between equal times
    seen.position[0][100] = seen.position[1][100] = 0;                    // farther than a bead can get
    seen.time[301] = seen.time[300] + 1e-9;                               // the same time, to the digits of a file
    names.push_back(fmt::format("b{}.a", i));
    std::ofstream(run.path() / names.back()) << camera::ctrack_text(seen);
    seen = camera::as_written(seen);
    seen.name = fmt::format("b{}", i);
    given.runs.push_back(seen);
  }
  std::ofstream(given.file) << camera::recording_text(names, given.condition, "both") << "frame: {axis: [0, 0, mm]}\n";
  const recording::Recording read = recording::read_recording(given.file), cleaned = recording::clean_recording(given);
  REQUIRE(read.runs.size() == cleaned.runs.size());
  CHECK(read.gap_limit == cleaned.gap_limit);
  for (std::size_t i = 0; i < read.runs.size(); ++i) {
    const recording::Run &a = read.runs[i], &b = cleaned.runs[i];
    CHECK(a.report.outliers == 1);
    CHECK(a.spread.at(7) != a.spread.at(8));
    CHECK(a.report.duplicates == 1);
    CHECK(a.name == b.name);
    CHECK(a.time == b.time);
    CHECK(a.position == b.position);
    CHECK(a.spread == b.spread);
    CHECK(a.events == b.events);
    CHECK(a.report.outliers == b.report.outliers);
    CHECK(a.report.duplicates == b.report.duplicates);
    CHECK(a.report.gaps == b.report.gaps);
  }
}
