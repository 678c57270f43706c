// A hypothesis that a third party builds out of tree against the installed SDK is found, described and asked for like ours.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/base/text.hpp"
#include "kernel/host/scaffold.hpp"
#include "scratch.hpp"
#include "studies/diagnose/question/candidates.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::Matchers::Contains;
using testing::Scratch;
namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& word) { return "'" + word + "'"; }

/// Runs a shell command; what it printed. The log is shown when it fails.
std::string run(const std::string& command, const fs::path& log) {
  const int status = std::system((command + " >" + quoted(log.string()) + " 2>&1").c_str());
  const std::string said = base::text_of(log);
  INFO(command << "\n" << said);
  REQUIRE(status == 0);
  return said;
}

/// A body force from the scaffold, with a hypothesis about its one parameter.
std::string write_wind(const Scratch& scratch) {
  const std::string project = host::scaffold(Kind::body_force, "wind", scratch.path.string());
  const fs::path source = fs::path(project) / "wind.cpp";
  std::string text = base::text_of(source);
  const auto replace = [&](const std::string& old, const std::string& with) {
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    text.replace(at, old.size(), with);
  };
  replace("class Wind",
          "constexpr Hypothesis kHypotheses[] = {\n"
          "    {\"wind\", \"A wind blows through the mill.\", \"F = -6 pi eta r v\", \"Their thesis 2024\", \"viscosity\", 1.8e-5, 1.8e-5, "
          "0.5, \"air_drag\"},\n};\n\nclass Wind");
  replace("    .parameters = kParameters,\n", "    .parameters = kParameters,\n    .hypotheses = kHypotheses,\n");
  std::ofstream(source) << text;
  return project;
}

/// The plugin, built out of tree against the SDK that this build installs; where it lies.
std::string build_wind(const Scratch& scratch) {
  const fs::path log = scratch / "log", sdk = scratch / "sdk";
  run(quoted(MILLSCOPE_CMAKE) + " --install " + quoted(MILLSCOPE_BINARY_DIR) + " --component sdk --prefix " + quoted(sdk.string()), log);
  const std::string project = write_wind(scratch), build = project + "/build";
  run(quoted(MILLSCOPE_CMAKE) + " -S " + quoted(project) + " -B " + quoted(build) +
          " -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=" + quoted(MILLSCOPE_CXX) + " -DCMAKE_PREFIX_PATH=" + quoted(sdk.string()),
      log);
  run(quoted(MILLSCOPE_CMAKE) + " --build " + quoted(build), log);
  return build + "/lib/millscope/plugins";
}

}  // namespace

TEST_CASE("a third party's hypothesis is found, described and asked for like ours") {
  const Scratch scratch;
  const fs::path log = scratch / "log";
  const std::string plugins = build_wind(scratch);

  const std::string page = run(quoted(MILLSCOPE_COMMAND) + " describe wind --plugin-dir " + quoted(plugins), log);
  CHECK_THAT(page, Contains("Hypothesis wind") && Contains("A wind blows through the mill."));
  CHECK_THAT(page, Contains("Their thesis 2024"));

  const host::Registry registry({{plugins}, true, {}});
  const std::string base = MILLSCOPE_SOURCE_DIR "/configs/mill10/case.yaml";
  const Library library = library_of(config::read_case(base, {}), registry);
  const auto wind = std::find_if(library.candidates.begin(), library.candidates.end(), [](const Candidate& c) { return c.name == "wind"; });
  REQUIRE(wind != library.candidates.end());
  CHECK(wind->sentence == "A wind blows through the mill.");
  CHECK(wind->unit == "Pa s");
  CHECK(wind->excludes == std::vector<std::string>{"air_drag"});
  CHECK(settings_of(*wind, 1) == std::vector<std::string>{"body_forces.wind.kind=wind", "body_forces.wind.viscosity=0.5"});
  const config::Case with = config::read_case(base, {"body_forces.wind.kind=wind"});
  const Library again = library_of(with, registry);
  CHECK(std::find(again.left_out.begin(), again.left_out.end(), "wind: wind is in the base case already") != again.left_out.end());
}

// The story's small mill, once with a wind of 0.05 Pa s and contacts half as stiff again: that is recorded. Nobody tells the simulation.
TEST_CASE("a third party's hypothesis is named on a recording made with it") {
  const Scratch scratch;
  const fs::path log = scratch / "log", story = fs::path(MILLSCOPE_SOURCE_DIR) / "configs" / "story";
  const std::string plugins = " --plugin-dir " + quoted(build_wind(scratch));
  const std::string command = "cd " + quoted(scratch.path.string()) + " && " + quoted(MILLSCOPE_COMMAND) + " ";
  std::string conditions;
  for (const std::string speed : {"75", "55"}) {
    run(command + "run " + quoted((story / "mill.yaml").string()) + " -o mill" + speed + plugins +
            " -q --set body_forces.wind.kind=wind --set body_forces.wind.viscosity=0.05 --set stiffness_factor=0.0003 --set seed=" + speed +
            " --set 'mill.speed=" + speed + " %critical' --set 'time={end_s: 6, analyze_from_s: 1}' --set 'output.tracks={beads: 40, " +
            "every_s: 0.0005}'",
        log);
    run(command + "pept synthesize mill" + speed + " -o r" + speed + ".a --camera " + quoted((story / "../cameras/study.yaml").string()),
        log);
    const std::string condition = " --set conditions.speed" + speed;
    conditions += condition + ".recording=" + quoted((scratch / ("r" + speed + ".yaml")).string()) + condition + ".set.time.end_s=2";
  }
  run(command + "diagnose " + quoted((story / "study.yaml").string()) + " -o out -q --draws 400 --cache cache" + plugins + conditions +
          " --set 'hypotheses={wind: {}, rolling_resistance: {}}' --set observe.beads=60",
      log);
  const auto found = nlohmann::json::parse(base::text_of(scratch / "out" / "diagnosis.json"));
  INFO(found["sentence"] << "\n" << found["hypotheses"].dump(1));
  CHECK(found["verdict"] == "named");
  REQUIRE(found["named"] == nlohmann::json::array({"wind"}));
  const auto wind = std::find_if(found["hypotheses"].begin(), found["hypotheses"].end(), [](const auto& h) { return h["name"] == "wind"; });
  REQUIRE(wind != found["hypotheses"].end());
  CHECK(found["sentence"].get<std::string>().find("A wind blows through the mill.") == 0);
  CHECK_THAT((*wind)["parameters"]["viscosity"]["value"].get<double>(), Catch::Matchers::WithinAbs(0.05, 0.02));
}
