// Whole studies of a small mill, through the command.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "dem/support.hpp"
#include "kernel/base/text.hpp"
#include "tests/scratch.hpp"

using namespace dem_test;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string kSliding = ", wear_coefficient: 1e-3, hardness: 2 GPa";

/// A slice of 100 mm with eight lifters and 90 beads of 8 mm.
std::string slice(const std::string& wear, const std::string& values) {
  Setup s;
  s.stiffness_factor = 1e-4;
  s.wear = wear;
  s.pairs = "restitution: 0.5, static_friction: 0.3" + values;
  s.beads = "{glass: {material: glass, diameter: 8 mm}}";
  s.fill = "{count: 90, settle_s: 0.1}";
  s.body_forces = kWithGravity;
  s.geometry =
      "{drum: {kind: mill, diameter: 100 mm, length: 30 mm, lifters: 8, lifter_height: 6 mm, lifter_width: 12 mm, material: wall, motion: "
      "mill}}";
  s.mill = "{speed: 8 rad/s}";
  s.domain = "{periodic: {z: [0, 30 mm]}}";
  s.time = "{end_s: 0.6, analyze_from_s: 0.2}";
  return s.text();
}

struct Said {
  int code;
  std::string text;
};

Said ask(const std::string& words, const fs::path& folder) {
  const fs::path text = folder / "said.txt";
  const std::string command = std::string(MILLSCOPE_BINARY_DIR) + "/bin/millscope " + words + " >" + text.string() + " 2>&1";
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), base::text_of(text)};
}

nlohmann::json result_of(const fs::path& folder) { return nlohmann::json::parse(base::text_of(folder / "wear.json")); }

}  // namespace

TEST_CASE("a liner wears away by what the laws say, and a study that is repeated computes nothing again") {
  const testing::Scratch scratch;
  const fs::path file = scratch / "case.yaml", out = scratch / "out";
  std::ofstream(file) << slice("{sliding: {kind: archard}, cutting: {kind: finnie}}", kSliding + ", cutting_share: 0.2");
  const std::string words = "wear " + file.string() + " --hours 200 --steps 2 --seeds 2 -o " + out.string();
  const Said first = ask(words, scratch.path);
  INFO(first.text);
  REQUIRE(first.code == 0);
  const nlohmann::json found = result_of(out);
  REQUIRE(found["stages"].size() == 3);
  CHECK(found["pitches"] == 8);
  const auto& last = found["stages"][2];
  CHECK(last["hours"].get<double>() == 200);
  CHECK(last["volume_lost_m3"].get<double>() > 0);
  CHECK(last["volume_lost_m3"].get<double>() == Approx(last["volume_of_the_laws_m3"].get<double>()).epsilon(0.01));
  CHECK(last["mass_lost_kg"].get<double>() == Approx(2500 * last["volume_lost_m3"].get<double>()).epsilon(1e-6));
  CHECK(last["volume_lost_error_m3"].get<double>() > 0);
  CHECK(last["volume_lost_error_m3"].get<double>() < last["volume_lost_m3"].get<double>());
  CHECK(last["power_W"].get<double>() > 0);
  for (const char* made : {"wear.csv", "profiles.csv", "pictures/liner.svg", "pictures/power.png", "stages/02/drum.stl", "liner_02.vtp"})
    CHECK(fs::exists(out / made));
  const std::string before = base::text_of(out / "wear.json");
  const Said again = ask(words, scratch.path);
  CHECK(again.code == 0);
  CHECK(base::text_of(out / "wear.json") == before);
  std::size_t simulations = 0;
  for (const auto& entry : fs::directory_iterator(out / "cache")) simulations += fs::exists(entry.path() / "task.json") ? 1 : 0;
  CHECK(simulations == 6);
}

TEST_CASE("a case without wear laws, hours or a mill is refused with the remedy") {
  const testing::Scratch scratch;
  const fs::path file = scratch / "case.yaml", out = scratch / "out";
  std::ofstream(file) << slice("{}", "");
  const Said none = ask("wear " + file.string() + " --hours 100 -o " + out.string(), scratch.path);
  CHECK(none.code != 0);
  CHECK_THAT(none.text, Contains("no wear law") && Contains("contact.wear"));
  std::ofstream(file) << slice("{sliding: {kind: archard}}", kSliding);
  const Said hours = ask("wear " + file.string() + " -o " + out.string(), scratch.path);
  CHECK(hours.code != 0);
  CHECK_THAT(hours.text, Contains("--hours"));
  const Said negative = ask("wear " + file.string() + " --hours -5 -o " + out.string(), scratch.path);
  CHECK(negative.code != 0);
  const Said pitches = ask("wear " + file.string() + " --hours 5 --pitches 7 -o " + out.string(), scratch.path);
  CHECK(pitches.code != 0);
  CHECK_THAT(pitches.text, Contains("does not repeat 7 times"));
  CHECK_FALSE(fs::exists(out / "wear.json"));
}
