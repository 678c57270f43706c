// challenge.yaml: what is read, and what is refused in one line with its place.
#include <catch2/catch.hpp>
#include <fstream>

#include "studies/challenge/plan.hpp"
#include "tests/scratch.hpp"

using namespace millscope::challenge;

namespace {

const std::string kText =
    "study: study.yaml\n"
    "camera: camera.yaml\n"
    "seed: 4\n"
    "truth: {set: {stiffness_factor: 0.01, contact.law.cap: sum}}\n"
    "beads: 7\n"
    "seconds: 500 ms\n"
    "sets:\n"
    "  - {kind: none, count: 3}\n"
    "  - {kind: effect, hypothesis: wear, strength: [50 %, 1]}\n"
    "  - {kind: two, hypotheses: [wear, rolling]}\n"
    "  - {kind: outside, name: soft, set: {pairs.glass~glass.restitution: 0.3, contact.law.cap: sum}}\n"
    "  - {kind: decoy, name: fuller, camera: camera.yaml, set: {fill.filling: 40 %}}\n";

std::filesystem::path write(const testing::Scratch& folder, const std::string& text) {
  std::ofstream(folder / "study.yaml") << "base: x\n";
  std::ofstream(folder / "camera.yaml") << "observations: {}\n";
  std::ofstream(folder / "c.yaml") << text;
  return folder / "c.yaml";
}

/// What is said when `from` reads `to`, without the folder.
std::string refused(const std::string& from, const std::string& to) {
  const testing::Scratch folder;
  std::string text = kText;
  REQUIRE(text.find(from) != std::string::npos);
  text.replace(text.find(from), from.size(), to);
  const std::string message = testing::refusal([&] { read_challenge(write(folder, text)); });
  CHECK(message.find('\n') == std::string::npos);
  return message.empty() ? "" : message.substr(folder.path.string().size() + 1);
}

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

}  // namespace

TEST_CASE("a challenge reads as it is written") {
  const testing::Scratch folder;
  const Challenge c = read_challenge(write(folder, kText), {"seed=9"});
  CHECK(c.seed == 9);
  CHECK(c.seconds == 0.5);
  CHECK(c.truth == std::vector<std::string>{"stiffness_factor=0.01", "contact.law.cap=sum"});
  REQUIRE(c.sets.size() == 5);
  CHECK(c.sets[0].count == 3);
  CHECK(c.sets[1].low == 0.5);
  CHECK(c.sets[2].hypotheses == std::vector<std::string>{"wear", "rolling"});
  CHECK(c.sets[3].settings == std::vector<std::string>{"pairs.glass~glass.restitution=0.3", "contact.law.cap=sum"});
  CHECK(c.sets[4].kind == Kind::decoy);
  CHECK(c.sets[4].settings == std::vector<std::string>{"fill.filling=40 %"});
  CHECK(c.sets[4].camera.filename() == "camera.yaml");
}

TEST_CASE("another engine may play the truth, with settings or without") {
  const testing::Scratch folder;
  std::string text = kText;
  text.replace(text.find("truth: {set: {stiffness_factor: 0.01, contact.law.cap: sum}}"), 60,
               "truth: {engine: liggghts, set: {stiffness_factor: 0.01}}    ");
  CHECK(read_challenge(write(folder, text), {}).truth == std::vector<std::string>{"stiffness_factor=0.01", "run.engine=liggghts"});
  CHECK(begins(refused("truth: {set: {stiffness_factor: 0.01, contact.law.cap: sum}}", "truth: {machine: liggghts}"), "c.yaml:4: "));
}

TEST_CASE("challenges that cannot work are refused with their place") {
  CHECK(begins(refused("kind: none", "kind: nothing"), "c.yaml:8: 'sets.0.kind' "));
  CHECK(begins(refused("count: 3", "count: 0"), "c.yaml:8: "));
  CHECK(begins(refused("count: 3", "hypothesis: wear"), "c.yaml:8: "));
  CHECK(begins(refused("[50 %, 1]", "[0.5]"), "c.yaml:9: 'sets.1.strength' has 1 values"));
  CHECK(begins(refused("[50 %, 1]", "[1, 0.5]"), "c.yaml:9: 'sets.1.strength' has its lower end above"));
  CHECK(begins(refused("[50 %, 1]", "[0.5, 2]"), "c.yaml:9: "));
  CHECK(begins(refused("[wear, rolling]", "[wear, wear]"), "c.yaml:10: 'sets.2.hypotheses' is no list of two"));
  CHECK(begins(refused("name: soft, ", ""), "c.yaml:11: "));
  CHECK(begins(refused("camera: camera.yaml, set: {fill.filling: 40 %}", "count: 2"), "c.yaml:12: 'sets.4' is like any set without"));
  CHECK(begins(refused("camera: camera.yaml, set", "camera: eye.yaml, set"), "c.yaml:12: 'sets.4.camera' is 'eye.yaml': no such file"));
  CHECK(begins(refused("study: study.yaml", "study: other.yaml"), "c.yaml:1: 'study' is 'other.yaml': no such file"));
  CHECK(begins(refused("camera: camera.yaml", "camera: eye.yaml"), "c.yaml:2: 'camera' is 'eye.yaml': no such file"));
  CHECK(begins(refused("seed: 4", "seed: -4"), "c.yaml:3: "));
  CHECK(begins(refused("truth: {set: {stiffness_factor: 0.01, contact.law.cap: sum}}", "truth: {set: 3}"),
               "c.yaml:4: 'truth.set' is no map"));
  CHECK(begins(refused("beads: 7", "bead: 7"), "c.yaml:5: "));
  CHECK(begins(refused("500 ms", "0 s"), "c.yaml:6: "));
}
