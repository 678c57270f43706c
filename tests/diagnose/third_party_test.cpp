// A hypothesis that a third party builds out of tree against the installed SDK is found, described and asked for like ours.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "kernel/host/scaffold.hpp"
#include "scratch.hpp"
#include "studies/diagnose/candidates.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::Matchers::Contains;
using testing::Scratch;
namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& word) { return "'" + word + "'"; }

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs a shell command; what it printed. The log is shown when it fails.
std::string run(const std::string& command, const fs::path& log) {
  const int status = std::system((command + " >" + quoted(log.string()) + " 2>&1").c_str());
  const std::string said = text_of(log);
  INFO(command << "\n" << said);
  REQUIRE(status == 0);
  return said;
}

/// A body force from the scaffold, with a hypothesis about its one parameter.
std::string write_wind(const Scratch& scratch) {
  const std::string project = host::scaffold(Kind::body_force, "wind", scratch.path.string());
  const fs::path source = fs::path(project) / "wind.cpp";
  std::string text = text_of(source);
  const auto replace = [&](const std::string& old, const std::string& with) {
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    text.replace(at, old.size(), with);
  };
  replace("class Wind",
          "constexpr Hypothesis kHypotheses[] = {\n"
          "    {\"wind\", \"A wind blows through the mill.\", \"F = -6 pi eta r v\", \"Their thesis 2024\", \"viscosity\", 1.8e-5, 1.8e-5, "
          "0.5, 0, 0, \"\", \"air_drag\"},\n};\n\nclass Wind");
  replace("  return d;\n", "  d.hypotheses = kHypotheses;\n  d.hypothesis_count = 1;\n  return d;\n");
  std::ofstream(source) << text;
  return project;
}

}  // namespace

TEST_CASE("a third party's hypothesis is found, described and asked for like ours") {
  const Scratch scratch;
  const fs::path log = scratch / "log", sdk = scratch / "sdk";
  run(quoted(MILLSCOPE_CMAKE) + " --install " + quoted(MILLSCOPE_BINARY_DIR) + " --component sdk --prefix " + quoted(sdk.string()), log);
  const std::string project = write_wind(scratch), build = project + "/build", plugins = build + "/lib/millscope/plugins";
  run(quoted(MILLSCOPE_CMAKE) + " -S " + quoted(project) + " -B " + quoted(build) + " -DCMAKE_CXX_COMPILER=" + quoted(MILLSCOPE_CXX) +
          " -DCMAKE_PREFIX_PATH=" + quoted(sdk.string()),
      log);
  run(quoted(MILLSCOPE_CMAKE) + " --build " + quoted(build), log);

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
