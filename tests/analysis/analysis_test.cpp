// Whole analyses through the plugins of this build: settings, choice, recordings, refusals.
#include "studies/analysis/analysis.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "analysis/support.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

analysis::AnalysisRequest request_for(const fs::path& path) {
  analysis::AnalysisRequest request;
  request.path = path;
  request.only = {"power"};
  return request;
}

analysis::ResultSet run(const analysis::AnalysisRequest& request) { return analysis::analyze(request, testing::registry()); }

/// A bead on a circle of 50 mm about the axis at (1.4, −0.9) mm, once round in π s, clockwise, seen at 200 Hz with noise of 0.2 mm.
void write_recording(const fs::path& file) {
  std::ofstream out(file);
  for (int i = 0; i < 9; ++i) out << "header " << i << '\n';
  Random random(5);
  for (int i = 0; i < 6000; ++i) {
    const double t = i / 200.0, a = -2 * t;
    char line[128];
    std::snprintf(line, sizeof line, "%.1f %.3f %.3f %.3f 1.0 0 0 50\n", 1000 * t, 1.4 + 50 * std::cos(a) + 0.2 * random.normal(),
                  -0.9 + 50 * std::sin(a) + 0.2 * random.normal(), 25 + 10 * std::sin(t) + 0.2 * random.normal());
    out << line;
  }
}

constexpr const char* kRecording = R"(files: [bead.a]
format: ctrack
condition:
  speed: 2 rad/s
  direction: clockwise
  mill_diameter: 200 mm
  mill_length: 50 mm
  bead_diameter: 4 mm
  bead_density: 2500
  filling: 30 %
  porosity: 0.4
frame: {axis: [1.4 mm, -0.9 mm]}
)";

}  // namespace

TEST_CASE("powers of a made-up drum come out as they were put in") {
  const Scratch scratch;
  Drum().write(scratch.path);
  const analysis::ResultSet r = run(request_for(scratch.path));
  CHECK_THAT(r.find("power", "power_shell")->value[0], WithinRel(0.3, 1e-9));
  CHECK_THAT(r.find("power", "power_dissipation")->value[0], WithinRel(0.15, 1e-9));
  CHECK_THAT(r.find("power", "turning_speed")->value[0], WithinRel(-2.0, 1e-9));
  CHECK(r.meta.case_file == fs::absolute(scratch / "case.resolved.yaml").string());
  CHECK(r.meta.inputs.size() == 2);
  CHECK(r.meta.inputs[0].hash.size() == 16);
  CHECK(r.meta.provenance["analyzers"]["power"]["cells_x"] == 50);
  CHECK(r.meta.provenance["plugins"][0]["name"] == "power");
}

TEST_CASE("settings and overrides choose analyzers and their parameters") {
  const Scratch scratch;
  Drum().write(scratch.path);
  analysis::AnalysisRequest request = request_for(scratch.path);
  request.only.clear();
  request.settings = scratch / "analysis.yaml";
  spill(request.settings,
        "analyzers:\n  coarse: {kind: pept_grid, cells_x: 5, cells_y: 4}\n  power: {}\nresampling: {draws: 50, seed: 3}\nfrom: 1.5 s\n");
  const analysis::ResultSet r = run(request);
  CHECK(r.meta.draws == 50);
  CHECK(r.meta.seed == 3);
  CHECK_THAT(r.meta.context.start, WithinAbs(1.5, 1e-9));
  REQUIRE(r.find("coarse", "occupancy") != nullptr);
  CHECK(r.find("coarse", "occupancy")->shape == std::vector<std::size_t>{4, 5});
  CHECK(r.find("power", "power_shell") != nullptr);
  CHECK(r.find("distributions", "shell_speed") == nullptr);  // not chosen
  request.overrides = {"analyzers.coarse.cells_x=7"};
  CHECK(run(request).find("coarse", "occupancy")->shape == std::vector<std::size_t>{4, 7});
  request.only = {"pept_grid"};  // by the plugin's name
  CHECK(run(request).find("power", "power_shell") == nullptr);
  analysis::AnalysisRequest plain = request_for(scratch.path);
  plain.only = {"pept_grid", "power"};
  plain.overrides = {"analyzers.pept_grid.cells_x=6"};  // --set alone makes no choice
  const analysis::ResultSet both = run(plain);
  CHECK(both.find("pept_grid", "occupancy")->shape == std::vector<std::size_t>{50, 6});
  CHECK(both.find("power", "power_shell") != nullptr);
}

TEST_CASE("without a choice all analyzers run that the data allow, and the others are named") {
  const Scratch scratch;
  Drum().write(scratch.path);
  analysis::AnalysisRequest request = request_for(scratch.path);
  request.only.clear();
  request.tracers = {"all"};
  const analysis::ResultSet r = run(request);
  CHECK(r.find("power", "power_gravity") != nullptr);
  CHECK(r.find("power", "power_shell") == nullptr);  // a followed bead knows no work of the walls
  const auto names_it = [](const std::string& reason) { return reason.find("collision_energy: ") == 0; };
  CHECK(std::any_of(r.meta.left_out.begin(), r.meta.left_out.end(), names_it));
  request.only = {"collision_energy"};
  CHECK_THAT(refusal([&] { run(request); }), Contains("'collision_energy' needs counts of impacts"));
}

TEST_CASE("a recording runs through the same analyzers, in the mill's frame") {
  const Scratch scratch;
  write_recording(scratch / "bead.a");
  spill(scratch / "recording.yaml", kRecording);
  analysis::AnalysisRequest request = request_for(scratch / "recording.yaml");
  request.only = {"power", "pept_grid", "slip"};
  const analysis::ResultSet r = run(request);
  CHECK(r.meta.source == "recording");
  CHECK(r.meta.context.is_recording == 1);
  CHECK_THAT(r.meta.context.mill_radius, WithinRel(0.1, 1e-12));
  CHECK_THAT(r.meta.context.charge_mass, WithinRel(0.6 * 0.3 * 3.14159265358979 * 0.01 * 0.05 * 2500, 1e-9));
  CHECK_THAT(r.find("pept_grid", "bead_time")->value[0], WithinRel(29.995, 1e-3));
  CHECK_THAT(r.find("power", "centre_of_mass_x")->value[0], WithinAbs(0, 2e-3));
  CHECK_THAT(r.find("power", "turning_speed")->value[0], WithinRel(-2.0, 1e-9));
  const std::vector<double>& speed = r.find("pept_grid", "speed")->value;
  for (const double v : speed) {
    if (std::isfinite(v)) CHECK_THAT(v, WithinAbs(0.1, 0.02));
  }
  // The bead alone shows where the axis is.
  analysis::AnalysisRequest bare = request_for(scratch / "bead.a");
  const analysis::ResultSet found = run(bare);
  CHECK_THAT(fmt::format("{}", fmt::join(found.meta.notes, "\n")), Contains("the mill's axis was found at x = 1."));
  CHECK_THAT(found.meta.context.omega, WithinRel(-2.0, 0.02));
  CHECK_THAT(found.meta.context.mill_radius, WithinRel(0.05, 0.02));
}

TEST_CASE("wrong settings are refused in one line with their place") {
  const Scratch scratch;
  Drum().write(scratch.path);
  const auto with = [&](const std::string& text) {
    analysis::AnalysisRequest request = request_for(scratch.path);
    request.only.clear();
    request.settings = scratch / "s.yaml";
    spill(request.settings, text);
    const std::string message = refusal([&] { run(request); });
    CHECK(message.find('\n') == std::string::npos);
    return message;
  };
  CHECK_THAT(with("analyzers: {pept_gird: {}}\n"), Contains("s.yaml:1") && Contains("pept_grid"));
  CHECK_THAT(with("analyzers: {power: {cells: 5}}\n"), Contains("s.yaml:1") && Contains("cells"));
  CHECK_THAT(with("analyzers: {power: 5}\n"), Contains("must hold the parameters"));
  CHECK_THAT(with("resampling: {draws: 3}\n"), Contains("draws") && Contains("20"));
  CHECK_THAT(with("trajectory: {low: 5 mm}\n"), Contains("'low'") && Contains("both ends"));
  CHECK_THAT(with("trajectory: {noise: 5 s}\n"), Contains("noise"));
  CHECK_THAT(with("analysers: {}\n"), Contains("analyzers"));
  CHECK_THAT(with("from: 2 m\n"), Contains("from"));
  CHECK_THAT(with("schema_version: 2\n"), Contains("is not 1"));
  analysis::AnalysisRequest request = request_for(scratch.path);
  request.only = {"powr"};
  CHECK_THAT(refusal([&] { run(request); }), Contains("'powr' is no analyzer here") && Contains("power"));
  request.only = {"power", "power"};
  CHECK_THAT(refusal([&] { run(request); }), Contains("twice"));
  request.only = {"power"};
  request.overrides = {"analyzers.power.cells_x=-4"};
  CHECK_THAT(refusal([&] { run(request); }), Contains("--set") && Contains("cells_x"));
}
