#include <fmt/format.h>

#include "studies/calibrate/study.hpp"
#include "tests/calibrate/made_up_mill.hpp"

using namespace millscope::calibrate;
using testing::Folder;
using testing::message_of;

namespace {

/// The message for a study whose line that begins with `key` is replaced, without the folder's name.
std::string refusal(const std::string& key, const std::string& line) {
  const Folder folder;
  folder.write("base.yaml", "schema_version: 1\n");
  folder.write("r.yaml", "files: [a.a]\n");
  std::string text =
      "\nbase: base.yaml\n"
      "conditions:\n"
      "  dry: {set: {mill.speed: 75 %critical}, recording: r.yaml, role: fit}\n"
      "parameters:\n"
      "  pairs.glass~glass.static_friction: {range: [0.1, 0.8], name: mu_s}\n"
      "  pairs.glass~glass.rolling: {range: [0, 0.2], name: mu_r}\n"
      "constraints: [mu_r < mu_s]\n"
      "budget: {simulations: 20}\n";
  const std::size_t begin = text.find("\n" + key) + 1;
  REQUIRE(begin != 0);
  text.replace(begin, text.find('\n', begin) - begin, line);
  const auto file = folder.write("s.yaml", text.substr(1));
  const std::string message = message_of([&] { read_study(file); });
  const std::string prefix = folder.path.string() + "/";
  return message.rfind(prefix, 0) == 0 ? message.substr(prefix.size()) : message;
}

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

}  // namespace

TEST_CASE("a study reads as it is written") {
  const Folder folder;
  const Study s = testing::study_of(folder,
                                    "  pairs.liner~glass.restitution: {range: [30 %, 0.9], tied: [pairs.glass~glass.restitution]}\n"
                                    "  pairs.glass~glass.static_friction: {range: [0.1, 0.8], centre: 0.4, step: 0.2}\n",
                                    "objective: {kind: chagas2015, terms: [slip.mean, {name: power.torque, weight: 0.5}]}\n"
                                    "method: response_surface\nbudget: {simulations: 40, wall: 75 min}\n"
                                    "design: {batch: 3, axial: face_centred}\nobserve: {camera: exact, beads: 300}\n");
  CHECK(s.conditions[0].settings == std::vector<std::string>{"mill.speed=75 %critical"});
  CHECK(s.with_role(Role::held_out) == std::vector<std::size_t>{1});
  CHECK(s.parameters[0].path == "pairs.glass~liner.restitution");
  CHECK(s.parameters[0].name == "restitution");
  CHECK(s.parameters[0].low == 0.3);
  CHECK(s.objective.terms[1].weight == 0.5);
  CHECK(s.budget.wall == 4500);
  CHECK(s.design.batch == 3);
  const std::vector<std::string> settings = settings_of(s, Eigen::Vector2d(0.5, 0.25));
  CHECK(settings == std::vector<std::string>{"pairs.glass~liner.restitution=0.5", "pairs.glass~glass.restitution=0.5",
                                             "pairs.glass~glass.static_friction=0.25"});
}

TEST_CASE("studies that cannot work are refused with their place") {
  CHECK(refusal("  pairs.glass~glass.static", "  pairs.glass~glass.static_friction: {range: [0.8, 0.1], name: mu_s}") ==
        "s.yaml:5: 'parameters.pairs.glass~glass.static_friction.range' is [0.8, 0.1]: the lower end is not below the upper one; turn them "
        "round");
  CHECK(begins(refusal("  pairs.glass~glass.static", "  pairs.glass~glass.static_friction: 0.3"),
               "s.yaml:5: 'parameters.pairs.glass~glass.static_friction' is no parameter"));
  CHECK(begins(refusal("  pairs.glass~glass.static", "  pairs.glass~glass.static_friction: {range: [0.1, 0.8], name: mu_r}"),
               "s.yaml:6: two parameters are called 'mu_r'"));
  CHECK(begins(refusal("  pairs.glass~glass.rolling",
                       "  pairs.glass~glass.rolling: {range: [0, 1], name: mu_r, tied: [pairs.glass~glass.static_friction]}"),
               "s.yaml:6: 'pairs.glass~glass.static_friction' is given by two parameters"));
  CHECK(begins(refusal("constraints", "constraints: [mu_s < 0.05]"), "s.yaml:7: 'constraints' leave nothing of the ranges"));
  CHECK(begins(refusal("constraints", "constraints: [mu_x < mu_s]"),
               "s.yaml:7: 'constraints.0' is 'mu_x < mu_s': 'mu_x' is no parameter of this study"));
  CHECK(begins(refusal("constraints", "constraints: [mu_r]"), "s.yaml:7: 'constraints.0' is 'mu_r': no inequality"));
  CHECK(begins(refusal("  dry", "  dry: {recording: r.yaml, role: held_out}"), "s.yaml:2: 'conditions' has no condition with 'role: fit'"));
  CHECK(begins(refusal("  dry", "  dry: {recording: gone.yaml, role: fit}"),
               "s.yaml:3: 'conditions.dry.recording' is 'gone.yaml': no such file"));
  CHECK(begins(refusal("base", "base: gone.yaml"), "s.yaml:1: 'base' is 'gone.yaml': no such file"));
  CHECK(begins(refusal("budget", "observe: {camera: gone.yaml}"),
               "s.yaml:8: 'observe.camera' is 'gone.yaml': no such file; check the path, or write 'recording'"));
  CHECK(begins(refusal("budget", "observe: {camera: .}"), "s.yaml:8: 'observe.camera' is '.': it is a folder"));
  CHECK(begins(refusal("budget", "budget: {simulation: 20}"), "s.yaml:8: unknown key 'simulation'"));
  CHECK(begins(refusal("budget", "buget: {simulations: 20}"), "s.yaml:8: unknown key 'buget'"));
  CHECK(begins(refusal("budget", "method: guess"), "s.yaml:8: 'method' is 'guess'"));
  CHECK(begins(refusal("budget", "objective: {kind: likelihood, terms: [slip]}"),
               "s.yaml:8: 'objective.terms.0' is 'slip'; write ANALYZER.RESULT"));
  CHECK(refusal("budget", "budget: {simulations: 30}") == "");
}

TEST_CASE("constraints hold where they should") {
  const Folder folder;
  const Study s = testing::study_of(folder, "  a.x: {range: [0, 1]}\n  a.y: {range: [0, 1]}\n", "constraints: [x < 0.5 * y, y <= 0.9]\n");
  CHECK(s.allowed(Eigen::Vector2d(0.2, 0.5)));
  CHECK_FALSE(s.allowed(Eigen::Vector2d(0.3, 0.5)));
  CHECK_FALSE(s.allowed(Eigen::Vector2d(0.2, 0.95)));
  CHECK(s.allowed(Eigen::Vector2d(0.2, 0.9)));
}
