// How the runs of a study are filmed.
#include "studies/calibrate/observe.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "kernel/base/text.hpp"
#include "kernel/output/frames.hpp"
#include "tests/calibrate/made_up_mill.hpp"
#include "tests/plugins.hpp"

using namespace millscope;
using calibrate::Observation;
using calibrate::Observer;
using testing::registry;

namespace {

constexpr double kSpeed = 2;  // rad/s

const std::string kDrum = testing::drum_case(12, 4);

constexpr const char* kCamera =
    "schema_version: 1\nobservations:\n  rate: {{kind: sampling, rate: 200 Hz}}\n  noise: {{kind: {}, white: [0.3, 0.3, 0.3, mm]}}\n";

/// A bead circles to the right of the axis, m.
std::array<double, 3> place(double t, double phase) {
  const double angle = kSpeed * t + phase, radius = 0.03 + 0.004 * std::sin(3 * phase);
  return {0.03 + radius * std::cos(angle), radius * std::sin(angle) - 0.03, 0.025};
}

/// Twelve beads that move as the recorded one does.
void write_run(const std::filesystem::path& run) {
  std::filesystem::create_directories(run);
  std::ofstream(run / "case.resolved.yaml") << kDrum;
  const std::vector<std::uint32_t> id{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, material(12, 0);
  const std::vector<double> radius(12, 0.002), mass(12, 8.4e-5), spin(36, 0.0), work{0.0};
  auto writer = output::FrameWriter::create(run / "frames.h5", {id, radius, mass, material, {"glass"}, {"shell"}, {}});
  for (int f = 0; f <= 800; ++f) {
    const double t = 0.005 * f, step = 1e-6;
    std::vector<double> position, velocity;
    for (const std::uint32_t bead : id) {
      const auto x = place(t, bead), next = place(t + step, bead);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        position.push_back(x[axis]);
        velocity.push_back((next[axis] - x[axis]) / step);
      }
    }
    writer.append({t, kSpeed * t, kSpeed, work, {}, {}, position, velocity, spin});
  }
  writer.close();
}

/// A study of that drum, with a recording of a minute.
calibrate::Study study_in(const testing::Folder& folder, const std::string& noise = "noise") {
  folder.write("drum.yaml", kDrum);
  folder.write("camera.yaml", fmt::format(kCamera, noise));
  std::string track = "t,x,y,z\n";
  for (int i = 0; i < 12000; ++i) {
    const double t = 0.005 * i;
    const auto x = place(t, 0.1 * std::floor(t / 4));
    const auto shaken = [i](int axis) { return 0.3 * std::sin(12.9898 * (3 * i + axis) * (1 + 0.37 * i)); };
    track += fmt::format("{},{:.4f},{:.4f},{:.4f}\n", 1e3 * t, 1e3 * x[0] + shaken(0), 1e3 * x[1] + shaken(1), 1e3 * x[2] + shaken(2));
  }
  folder.write("track.csv", track);
  folder.write("r.yaml",
               "files: [track.csv]\nformat: table\nframe: {axis: [0, 0]}\n"
               "condition: {speed: 2 rad/s, geometry: drum.yaml, bead_diameter: 4 mm}\n");
  return calibrate::read_study(folder.write("study.yaml",
                                            "base: drum.yaml\nconditions: {dry: {recording: r.yaml, role: fit}}\n"
                                            "observe: {camera: camera.yaml}\n"
                                            "parameters: {pairs.glass~glass.static_friction: {range: [0.1, 0.8]}}\n"));
}

Observer observer_of(const calibrate::Study& study, const host::Registry& plugins, const std::filesystem::path& cache) {
  return Observer(study, plugins, calibrate::read_recordings(study), {cache, 1, {}});
}

campaign::Outcome finished(const std::filesystem::path& run, const std::string& key) {
  campaign::Outcome outcome;
  outcome.state = campaign::State::done;
  outcome.folder = run;
  outcome.key = key;
  return outcome;
}

/// The camera's noise under another name, as a third party would have it: edited, built in a folder of its own.
std::filesystem::path build_shake(const testing::Folder& folder, const std::string& name, const std::string& old, const std::string& with) {
  const std::filesystem::path place = folder.path / name, sources = std::filesystem::path(MILLSCOPE_SOURCE_DIR) / "plugins/observations";
  std::filesystem::create_directories(place);
  std::string text = base::text_of(sources / "noise.cpp");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"noise\"", "\"shake\""}, {old, with}}) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  }
  std::ofstream(place / "shake.cpp") << text;
  const std::string command = std::string(MILLSCOPE_CXX) +
                              " -std=c++20 -O1 -DNDEBUG -fPIC -shared -fvisibility=hidden -I '" MILLSCOPE_SOURCE_DIR "/sdk/include' -I '" +
                              sources.string() + "' -o '" + (place / "libshake.so").string() + "' '" + (place / "shake.cpp").string() +
                              "' && chmod go-w '" + place.string() + "' '" + (place / "libshake.so").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  return place;
}

}  // namespace

TEST_CASE("two runs of one condition do not share the camera's chance, one run always has the same") {
  const testing::Folder folder;
  const calibrate::Study study = study_in(folder);
  const std::filesystem::path run = folder.path / "run";
  write_run(run);
  const Observer observer = observer_of(study, registry(), folder.path / "observations");
  // The beads are the same, so that only the camera can differ.
  const Observation one = observer.simulated(0, finished(run, "one-program")),
                    other = observer.simulated(0, finished(run, "other-program"));
  CHECK(one.value != other.value);
  CHECK(observer_of(study, registry(), folder.path / "elsewhere").simulated(0, finished(run, "one-later")).value == one.value);
  const std::string again = "analyzers: {power: {}}\n";
  const auto power = [&](const std::string& key) {
    return observer.results(0, finished(run, key), again).find("power", "specific_power_gravity")->value;
  };
  CHECK(power("one") == power("one"));
  CHECK(power("one") != power("other"));
}

TEST_CASE("a recording is looked through anew when a file that its case includes has changed") {
  const testing::Folder folder;
  const calibrate::Study study = study_in(folder);
  std::string text = kDrum;
  const std::string beads = "beads: {charge: {material: glass, diameter: 4 mm}}\n";
  text.replace(text.find(beads), beads.size(), "include: [beads.yaml]\n");
  folder.write("drum.yaml", text);
  const auto times_looked_through = [&](const std::string& diameter) {
    folder.write("beads.yaml", "beads: {charge: {material: glass, diameter: " + diameter + "}}\n");
    observer_of(study, registry(), folder.path / "observations");
    const std::filesystem::directory_iterator files(folder.path / "observations");
    return std::count_if(begin(files), end(files),
                         [](const auto& file) { return file.path().filename().string().starts_with("recording-"); });
  };
  CHECK(times_looked_through("4 mm") == 1);
  CHECK(times_looked_through("4.0 mm") == 1);
  CHECK(times_looked_through("4.1 mm") == 2);
}

TEST_CASE("what was seen is seen again when a camera's code has changed, not when its comments have") {
  const testing::Folder folder;
  const std::filesystem::path run = folder.path / "run", cache = folder.path / "observations";
  write_run(run);
  const auto with = [&](const std::filesystem::path& own) {
    return host::Registry({{MILLSCOPE_BINARY_DIR "/lib/millscope/plugins", own.string()}, false, {}});
  };
  const std::string begin = "#include", first = build_shake(folder, "first", begin, begin);
  const host::Registry original = with(first), commented = with(build_shake(folder, "commented", begin, "// A comment.\n\n#include"));
  const host::Registry changed = with(build_shake(folder, "changed", "white_[axis] * a", "1.01 * white_[axis] * a"));
  calibrate::Study study = study_in(folder, "shake");
  const Observation seen = observer_of(study, original, cache).simulated(0, finished(run, "one-program"));
  std::filesystem::remove_all(run);
  CHECK(observer_of(study, commented, cache).simulated(0, finished(run, "one-program")).value == seen.value);
  CHECK_THROWS(observer_of(study, changed, cache).simulated(0, finished(run, "one-program")));
}
