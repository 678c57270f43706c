// An analyzer that a third party builds out of tree against the installed SDK runs in `analyze` like ours, on a simulation and on a
// recording.
#include <catch2/catch.hpp>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "analysis/support.hpp"
#include "kernel/host/scaffold.hpp"

using namespace analysis_test;
using Catch::Matchers::WithinRel;

namespace {

std::string quoted(const std::string& word) { return "'" + word + "'"; }

/// Runs a shell command with its output in a log; the log is shown when it fails.
void run(const std::string& command, const fs::path& log) {
  const int status = std::system((command + " >" + quoted(log.string()) + " 2>&1").c_str());
  std::ifstream in(log);
  INFO(command << "\n" << std::string(std::istreambuf_iterator<char>(in), {}));
  REQUIRE(status == 0);
}

/// Scaffolds an analyzer, installs the SDK beside it and builds the one against the other; the plugin's directory.
fs::path build_their_analyzer(const Scratch& scratch) {
  const fs::path log = scratch / "log", sdk = scratch / "sdk";
  run(quoted(MILLSCOPE_CMAKE) + " --install " + quoted(MILLSCOPE_BINARY_DIR) + " --component sdk --prefix " + quoted(sdk.string()), log);
  const std::string project = host::scaffold(Kind::analyzer, "their_speed", scratch.path.string()), build = project + "/build";
  run(quoted(MILLSCOPE_CMAKE) + " -S " + quoted(project) + " -B " + quoted(build) + " -DCMAKE_CXX_COMPILER=" + quoted(MILLSCOPE_CXX) +
          " -DCMAKE_PREFIX_PATH=" + quoted(sdk.string()),
      log);
  run(quoted(MILLSCOPE_CMAKE) + " --build " + quoted(build), log);
  return build + "/lib/millscope/plugins";
}

nlohmann::json analyze(const fs::path& source, const fs::path& plugins, const Scratch& scratch, const std::string& name) {
  const fs::path output = scratch / name;
  run(quoted(MILLSCOPE_COMMAND) + " analyze " + quoted(source.string()) + " -o " + quoted(output.string()) + " --plugin-dir " +
          quoted(plugins.string()) + " --analyzers their_speed",
      scratch / "log");
  std::ifstream in(output / "results.json");
  return nlohmann::json::parse(in);
}

}  // namespace

TEST_CASE("a third party's analyzer measures simulations and recordings, with uncertainty and provenance") {
  const Scratch scratch;
  const fs::path plugins = build_their_analyzer(scratch);
  const Drum drum;
  drum.write(scratch / "run");
  const nlohmann::json simulated = analyze(scratch / "run", plugins, scratch, "simulated");
  // All beads turn at 2 rad/s; their radii are 20, 30 … 70 mm.
  CHECK_THAT(simulated["numbers"]["their_speed"]["mean_speed"]["value"].get<double>(), WithinRel(2 * 0.045, 1e-6));
  CHECK(simulated["numbers"]["their_speed"]["mean_speed"]["unit"] == "m/s");
  CHECK(simulated["provenance"]["plugins"][0]["name"] == "their_speed");
  // What it says of its results arrives: its beads' time is bookkeeping.
  CHECK(simulated["numbers"]["their_speed"]["bead_time"]["traits"] == nlohmann::json({"bookkeeping", "not negative"}));
  CHECK(simulated["numbers"]["their_speed"]["mean_speed"]["traits"].empty());

  std::ofstream out(scratch / "bead.csv");
  out << "# t x y z error\n";
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.005 * i, a = drum.omega * t;
    out << 1000 * t << ' ' << 40 * std::cos(a) << ' ' << 40 * std::sin(a) << ' ' << 20 + 5 * std::sin(3 * t) << " 1\n";
  }
  out.close();
  spill(scratch / "recording.yaml",
        "files: [bead.csv]\ncondition: {speed: 2 rad/s, direction: clockwise, mill_diameter: 200 mm}\nframe: {axis: [0 mm, 0 mm]}\n");
  const nlohmann::json recorded = analyze(scratch / "recording.yaml", plugins, scratch, "recorded");
  const nlohmann::json& speed = recorded["numbers"]["their_speed"]["mean_speed"];
  CHECK_THAT(speed["value"].get<double>(), WithinRel(0.0808, 0.01));  // 0.08 m/s round the axis, up to 0.015 m/s along it
  CHECK(speed["low_90"].get<double>() < speed["value"].get<double>());
  CHECK(recorded["blocks"].get<int>() >= 2);
}
