// One road for recordings and simulated beads: the same options, the same results, files that are read once, and nothing lost in the cache.
#include <fmt/format.h>

#include <fstream>

#include "studies/calibrate/json.hpp"
#include "studies/calibrate/observe.hpp"
#include "studies/calibrate/power.hpp"
#include "tests/calibrate/made_up_mill.hpp"
#include "tests/inspect/synthetic.hpp"
#include "tests/plugins.hpp"

using namespace millscope;
using namespace millscope::calibrate;
using Catch::Contains;
using testing::registry;

namespace {

/// A clockwise mill of 6 rad/s, its tracer on a circle of 145 mm.
const recording::Recording& made_recording() {
  static const recording::Recording made = [] {
    recording::Recording r = millscope::test::make_recording(millscope::test::SyntheticMill{});
    r.file = "mill.yaml";
    r.gap_limit = 0.05;
    r.condition.angular_velocity = -6, r.condition.speed = 6;
    r.condition.mill_diameter = 0.3;
    r.condition.bead_diameter = 0.01, r.condition.bead_density = 2500;
    return r;
  }();
  return made;
}

const std::string kCase = R"(schema_version: 1
materials: {glass: {density: 2500, young_modulus: 1e8, poisson_ratio: 0.23}}
beads: {charge: {material: glass, diameter: 10 mm}}
fill: {count: 10}
contact: {law: {kind: hertz_mindlin}}
pairs: {glass~glass: {restitution: 0.8, static_friction: 0.3}}
body_forces: {gravity: {kind: gravity}}
mill: {diameter: 300 mm, speed: 6 rad/s, direction: clockwise}
geometry: {shell: {kind: cylinder, radius: 150 mm, length: 60 mm, end_faces: false, material: glass, motion: mill}}
domain: {periodic: {z: [0, 60 mm]}}
time: {end_s: 1, analyze_from_s: 0}
)";

Study study_in(const testing::Folder& folder, const std::string& more) {
  folder.write("case.yaml", kCase);
  std::string rows = "t,x,y,z\n";
  const recording::Run& run = made_recording().runs[0];
  for (std::size_t i = 0; i < run.size(); ++i)
    rows += fmt::format("{:.5f},{:.6f},{:.6f},{:.6f}\n", 1e3 * run.time[i], 1e3 * run.position[0][i], 1e3 * run.position[1][i],
                        1e3 * run.position[2][i]);
  folder.write("bead.csv", rows);
  folder.write("r.yaml",
               "files: [bead.csv]\ncondition: {mill_diameter: 300 mm, bead_diameter: 10 mm, speed: 6 rad/s, direction: clockwise}\n");
  return read_study(folder.write("study.yaml",
                                 "base: case.yaml\nconditions: {wet: {recording: r.yaml, role: fit}}\n"
                                 "parameters: {pairs.glass~glass.static_friction: {range: [0.1, 0.8]}}\n" +
                                     more));
}

}  // namespace

TEST_CASE("recorded and simulated tracks are followed by the same options") {
  const Smoothing smoothing{{3e-4, 4e-4, 5e-4}, 0.3, {1, 2, 3}, 0.04, {4, 5e-4}, {1, 2}};
  Observing observing;
  CHECK(trajectory_options(Side::recorded, smoothing, observing) == trajectory_options(Side::simulated, smoothing, observing));
  observing.camera = "eye.yaml";
  const trajectory::TrajectoryOptions plain = trajectory_options(Side::simulated, smoothing, observing);
  CHECK(plain == trajectory_options(Side::recorded, smoothing, observing));
  CHECK(plain.noise == smoothing.noise);
  CHECK(plain.noise_correlation == smoothing.noise_correlation);
  CHECK(plain.roughness == smoothing.roughness);
  CHECK(plain.gap_limit == smoothing.gap_limit);
  CHECK(plain.travel == smoothing.travel);

  // The two differences that are meant: places along the recorded mill, and beads without a camera's noise.
  observing.z_low = 0.1, observing.z_high = 0.2;
  CHECK(trajectory_options(Side::simulated, smoothing, observing) == plain);
  trajectory::TrajectoryOptions recorded = trajectory_options(Side::recorded, smoothing, observing);
  CHECK((recorded.low == 0.1 && recorded.high == 0.2));
  recorded.low = recorded.high = 0;
  CHECK(recorded == plain);
  observing.camera = "exact";
  trajectory::TrajectoryOptions exact = trajectory_options(Side::simulated, smoothing, observing);
  CHECK((exact.noise == std::array<double, 3>{} && !exact.noise_correlation && exact.roughness == std::array<double, 3>{}));
  exact.noise = smoothing.noise, exact.noise_correlation = smoothing.noise_correlation, exact.roughness = smoothing.roughness;
  CHECK(exact == plain);
}

TEST_CASE("the same tracks give the same bits, be they recorded or simulated") {
  const testing::Folder folder;
  const Study study = study_in(folder, "observe: {draws: 100}\n");
  const Processing how{study, registry(), 1, analyzers_of(study, registry())};
  Smoothing smoothing = smoothing_of(made_recording());
  const analysis::RecordedMill mill = analysis::know_mill(made_recording(), {});
  const analysis::ResultSet a = process({made_recording(), mill, Side::recorded}, smoothing, how);
  smoothing.blocks = a.meta.lengths;  // as a look at a recording leaves them
  const analysis::ResultSet b = process({made_recording(), mill, Side::simulated}, smoothing, how);
  REQUIRE(a.arrays.size() == b.arrays.size());
  std::size_t numbers = 0;
  for (std::size_t i = 0; i < a.arrays.size(); ++i) {
    const auto same = [](const auto& p, const auto& q) {
      return p.size() == q.size() && std::equal(p.begin(), p.end(), q.begin(), [](auto x, auto y) { return x == y || (x != x && y != y); });
    };
    INFO(a.arrays[i].analyzer << "." << a.arrays[i].name);
    CHECK(same(a.arrays[i].value, b.arrays[i].value));
    CHECK(same(a.arrays[i].draws, b.arrays[i].draws));
    numbers += a.arrays[i].draws.size();
  }
  CHECK(numbers > 10000);
  // What neighbouring blocks have in common widens all draws alike.
  smoothing.blocks.correlation = 0;
  const analysis::ResultSet none = process({made_recording(), mill, Side::simulated}, smoothing, how);
  smoothing.blocks.correlation = 0.5;
  const analysis::ResultSet half = process({made_recording(), mill, Side::simulated}, smoothing, how);
  const std::vector<float>&narrow = none.find("power", "centre_of_mass_x")->draws, &wide = half.find("power", "centre_of_mass_x")->draws;
  for (std::size_t b = 0; b < narrow.size(); ++b) CHECK(wide[b] == Approx(std::sqrt(3.0) * narrow[b]).epsilon(1e-5));
}

TEST_CASE("summaries do not feel that nothing else is resampled") {
  const testing::Folder folder;
  const Study study = study_in(
      folder, "observe: {draws: 100}\nobjective: {kind: likelihood, terms: [power.specific_power_bbosa, pept_grid.outside_fraction]}\n");
  Processing how{study, registry(), 1, analyzers_of(study, registry())};
  const Tracks tracks{made_recording(), analysis::know_mill(made_recording(), {}), Side::recorded};
  const analysis::ResultSet all = process(tracks, smoothing_of(made_recording()), how);
  how.all_uncertain = false;
  const analysis::ResultSet few = process(tracks, smoothing_of(made_recording()), how);
  const std::vector<Summary> summaries = choose_summaries(all, study, {true, 1});
  CHECK(choose_summaries(few, study, {true, 1}) == summaries);
  CHECK(summaries.size() > 20);
  CHECK(summarise(few, summaries) == summarise(all, summaries));
  CHECK(beads_power(few, 1, "") == beads_power(all, 1, ""));
  CHECK(few.find("distributions", "x_cumulative")->sem.empty());
}

TEST_CASE("a recording is read once: what looks at it later needs its file no more") {
  const testing::Folder folder;
  const Study study = study_in(folder, "observe: {camera: exact, draws: 100}\n");
  const Observer observer(study, registry(), read_recordings(study), {folder.path / "cache", 1, {}});
  const auto again = [&] { return observer.results(0, {}, "analyzers:\n  power: {cells_x: 25, cells_y: 25}\n"); };
  const double before = again().find("power", "specific_power_gravity")->value.at(0);
  const inspect::MillMotion& motion = observer.recording(0).motion();
  std::filesystem::remove(folder.path / "bead.csv");
  std::filesystem::remove(folder.path / "r.yaml");
  CHECK(again().find("power", "specific_power_gravity")->value.at(0) == before);
  CHECK(&observer.recording(0).motion() == &motion);
  CHECK(observer.recording(0).tracks().runs[0].size() > 1000);
}

TEST_CASE("a camera file that is none is refused before anything is simulated") {
  const testing::Folder folder;
  folder.write("eye.yaml", "schema_version: 1\nobservations:\n  noise: {kind: noize}\n");
  const Study study = study_in(folder, "observe: {camera: eye.yaml, draws: 100}\n");
  CHECK_THAT(testing::message_of([&] {
               Observer(study, registry(), read_recordings(study), {folder.path / "cache", 1, {}});
             }),
             Contains("eye.yaml:3") && Contains("noize"));
}

TEST_CASE("the study's own analyzers come beside those of the room, under names of their own") {
  const testing::Folder folder;
  const Study more = study_in(folder, "analyzers: {mine: {kind: power, cells_x: 9}}\n");
  const auto asked = analyzers_of(more, registry());
  REQUIRE(asked.size() == 4);
  CHECK(asked[3].name == "mine");
  const Study twice = study_in(folder, "analyzers: {power: {}}\n");
  CHECK_THAT(testing::message_of([&] { analyzers_of(twice, registry()); }), Contains("study.yaml:4") && Contains("calibrate uses itself"));
}

TEST_CASE("a metered power owes nothing to the tracks, also where it is not compared") {
  Observation o;
  o.observables = {{"centre", "mm", ObservableKind::centre}, {"power", "W", ObservableKind::power}};
  o.value = Eigen::Vector2d(1, 2);
  o.covariance = (Eigen::Matrix2d() << 4, 1, 1, 9).finished();
  set_metered_power(o, {7, 0.5, "measured"});
  CHECK(o.value == Eigen::Vector2d(1, 7));
  CHECK(o.covariance == (Eigen::Matrix2d() << 4, 0, 0, 0.25).finished());
  set_metered_power(o, {7, 0, "measured"});
  CHECK(o.covariance(1, 1) == Approx(49e-12));
  leave_out(o, {"power"});
  set_metered_power(o, {8, 0.5, "measured"});
  CHECK(o.value[0] == 1);
  CHECK(o.power.value == 8);
}

TEST_CASE("nothing of what is cached of a recording is lost") {
  // A member that is added to a struct breaks the binding to its members: give it a value here, and a name in json.hpp.
  Summary s;
  auto& [observable, kind, analyzer, result, weight, cells, factor, places] = s;
  observable = {"speed there", "m/s", ObservableKind::region_speed};
  kind = Summary::along, analyzer = "pept_grid", result = "speed", weight = "occupancy", cells = {3, 7}, factor = 1e3, places = {0.1, 0.25};
  Observation o;
  auto& [of, observables, value, covariance, resampled, power, x, speed, bead_seconds, blocks, notes] = o;
  of = "r.yaml", observables = {observable, {"power", "W", ObservableKind::power}}, value = Eigen::Vector2d(1.0 / 3.0, 8);
  covariance = (Eigen::Matrix2d() << 1, 0.3, 0.3, 4).finished(), resampled = 0.5 * covariance;
  auto& [watts, sem, how] = power;
  watts = 8, sem = 0.1, how = "measured";
  x = {{0, 1, 2}, {40, 60}, {1, 1.5}}, speed = {{0, 1}, {100}, {0.25}}, bead_seconds = 600, blocks = 41, notes = {"a note"};
  RecordedCondition r;
  auto& [observation, summaries, analyzers, camera, smoothing, place, mass, omega, measured_power, axis_path, axis_noise, identity] = r;
  observation = o, summaries = {s}, analyzers = "analyzers: {}", camera = "observations: {}";
  auto& [noise, noise_correlation, roughness, gap_limit, travel, lengths] = smoothing;
  noise = {1e-4, 2e-4, 3e-4}, noise_correlation = 0.2, roughness = {1, 2, 3}, gap_limit = 0.04;
  auto& [greatest_speed, greatest_noise] = travel;
  greatest_speed = 4, greatest_noise = 5e-4;
  auto& [least, wished, correlation] = lengths;
  least = 1.5, wished = 2.5, correlation = 0.1;
  auto& [low, high, middle] = place;
  low = 0.01, high = 0.09, middle = 0.05;
  mass = 11, omega = -6, measured_power = true, axis_path = 0.07, axis_noise = 5e-4, identity = "0123";
  const testing::Folder folder;
  write_cached(folder.path / "r.json", r);
  const auto back = read_cached<RecordedCondition>(folder.path / "r.json");
  REQUIRE(back);
  CHECK(*back == r);
}

TEST_CASE("a file of the cache that is damaged, of another shape or absent is as if it were not there") {
  const testing::Folder folder;
  const auto cached = [&](const std::string& text) { return read_cached<Observation>(folder.write("o.json", text)).has_value(); };
  CHECK_FALSE(read_cached<Observation>(folder.path / "gone.json"));
  CHECK_FALSE(cached("{\"of\": "));
  CHECK_FALSE(cached("{\"of\": \"a mill\"}"));
  Observation o;
  o.observables = {{"x", "%", ObservableKind::x}};
  o.value = Eigen::VectorXd::Constant(1, 2), o.covariance = Eigen::MatrixXd::Constant(1, 1, 3);
  std::string text = nlohmann::json(o).dump();
  CHECK(cached(text));
  text.replace(text.find("\"x\""), 3, "\"q\"");
  CHECK_FALSE(cached(text));
}
