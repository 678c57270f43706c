// What a diagnosis leaves: figures for programs, a page for people, a corrected case to go on with.
#include "studies/diagnose/pages/outputs.hpp"
#include "kernel/base/text.hpp"

#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <span>

#include "kernel/config/writer.hpp"
#include "made_up_study.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinAbs;
using Catch::WithinRel;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

const std::string kFilling = "nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %, name: filling}}\n";
const std::string kRolling = "pairs.glass~glass.rolling_friction";

/// A diagnosis of recordings made with `truth`, written to folder/out.
nlohmann::json written(const Scratch& folder, const std::vector<std::string>& truth, const std::string& nuisances = kFilling,
                       double recording_noise = 1) {
  const Question q = question_of(folder, nuisances +
                                             "hypotheses: {rolling_resistance: {}, lifter_wear: {}}\n"
                                             "observe: {beads: 300}\n"
                                             "bank: {base: 26, each: 11, apart: 9, first: 3, develop_turns: 0.5}\n");
  MadeUpMill mill(q, {{kRolling, 0, 0.2, 3, {21, 22, 23}}, {"geometry.liner.lifter_height", 0.005, 0.003, 3, {41, 42, 43}}}, truth,
                  recording_noise);
  naming::Options options;
  options.draws = 240, options.comparison_draws = 160;
  const Diagnosis d = diagnose::diagnose(q, mill.machinery(), mill.evidence(), options);
  write_outputs({q, d}, folder / "out");
  return nlohmann::json::parse(base::text_of(folder / "out/diagnosis.json"));
}

const std::vector<std::string> kBase{"pairs.glass~glass.static_friction=0.3", "pairs.glass~liner.static_friction=0.4",
                                     "fill.filling=0.313"};

std::vector<std::string> with_rolling() {
  std::vector<std::string> truth = kBase;
  truth.push_back(kRolling + "=0.12");
  return truth;
}

bool is_interval(const nlohmann::json& j) {
  return j.contains("value") && j.contains("low90") && j.contains("high90") && j["low90"] <= j["high90"];
}

}  // namespace

TEST_CASE("diagnosis.json has every figure that is promised") {
  const Scratch folder;
  const nlohmann::json j = written(folder, with_rolling());
  CHECK(j["schema_version"] == 2);
  CHECK(j["hypotheses"][0]["lambda_at"][0].contains("strength"));  // version 1 called it a share
  CHECK_FALSE(j["hypotheses"][0]["lambda_at"][0].contains("share"));
  CHECK(j["verdict"] == "named");
  CHECK(j["named"] == nlohmann::json({"rolling_resistance"}));
  CHECK(j["next_experiment"] == "");
  REQUIRE(j["hypotheses"].size() == 3);
  for (const auto& h : j["hypotheses"]) {
    INFO(h.dump());
    for (const char* key : {"name", "p_value", "delta_q", "kappa", "lambda", "parameters", "class"}) CHECK(h.contains(key));
    CHECK(h["p_value"] > 0);
    CHECK(h["p_value"] <= 1);
    CHECK(h["kappa"] <= 1);
    for (const auto& [name, value] : h["parameters"].items()) CHECK(is_interval(value));
  }
  const auto& rolling = j["hypotheses"][0];
  CHECK(rolling["name"] == "rolling_resistance");
  CHECK(rolling["class"] == "best");
  CHECK_THAT(rolling["parameters"]["rolling_friction"]["value"].get<double>(), WithinAbs(0.12, 0.03));
  CHECK(j["hypotheses"][1]["class"] == "rejected");
  CHECK(j["hypotheses"][2]["kind"] == "nuisance");
  REQUIRE(j["mismatch"].size() == 32);
  for (const char* key : {"observable", "region", "condition", "z", "p_value", "sentence"}) CHECK(j["mismatch"][0].contains(key));
  CHECK(std::fabs(j["mismatch"][0]["z"].get<double>()) >= std::fabs(j["mismatch"][31]["z"].get<double>()));
  for (const char* part : {"retuned", "unmasked"}) {
    REQUIRE(j["contact_parameters"][part].size() == 3);
    for (const auto& [name, value] : j["contact_parameters"][part].items()) CHECK(is_interval(value));
  }
  REQUIRE(j["per_speed_friction"].size() == 3);
  CHECK(is_interval(j["per_speed_friction"][0]["before"]["bead_friction"]));
  CHECK(is_interval(j["per_speed_friction"][0]["after"]["bead_friction"]));
  const auto& held = j["held_out"][0];
  CHECK(held["condition"] == "speed50");
  CHECK(held["improves_on_every_rival"] == true);
  CHECK(held["observables"].size() == 16);
  for (const char* key : {"recorded", "corrected", "retuned to power"}) CHECK(held["observables"][0].contains(key));
  for (std::size_t k = 1; k < held["models"].size(); ++k) CHECK(is_interval(held["models"][k]["improvement_of_corrected"]));
  CHECK(held["models"][0]["simulated"] == true);
  CHECK(held["simulations"] >= 12);
  for (const auto& model : held["models"]) {
    CHECK((model["from"] == "simulations" || model["from"] == "surrogate"));
    const bool computed = model["model"] == "placebo" || model["model"] == "Gaussian-process discrepancy";
    CHECK(model["simulated"] == (!computed && model["from"] == "simulations"));
    if (model["model"] == "corrected") continue;
    CHECK(model["left_out_error"] > 0);
    if (model["from"] == "surrogate") CHECK(model["left_out_error"] < 0.5 * model["judged_difference"].get<double>());
  }
  CHECK(j["bank"]["failures"].empty());
  CHECK(j["doubts"].empty());
}

TEST_CASE("diagnosis.md tells the verdict, every candidate, the figures and the pictures, which are there") {
  const Scratch folder;
  const nlohmann::json j = written(folder, with_rolling());
  const std::string page = base::text_of(folder / "out/diagnosis.md");
  CHECK_THAT(page, Contains("**named**") && Contains(j["sentence"].get<std::string>()));
  for (const auto& h : j["hypotheses"]) CHECK_THAT(page, Contains(h["name"].get<std::string>()));
  CHECK_THAT(page, Contains("| corrected: with the best candidate, all parameters fitted together | simulated |"));
  CHECK_THAT(page, Contains("simulations were made for this, beside the bank's."));
  CHECK_THAT(page, Contains("retuned to power") && Contains("Gaussian-process discrepancy") && Contains("placebo"));
  CHECK_THAT(page, Contains(j["mismatch"][0]["sentence"].get<std::string>()));
  CHECK_THAT(page, !Contains("nan") && !Contains("inf"));
  int pictures = 0;
  for (const char* name : {"mismatch", "alone_1", "alone_2", "held_out_3"}) {
    CHECK(std::filesystem::file_size(folder / ("out/pictures/" + std::string(name) + ".svg")) > 1000);
    CHECK(std::filesystem::file_size(folder / ("out/pictures/" + std::string(name) + ".png")) > 1000);
    pictures += page.find("pictures/" + std::string(name) + ".svg") != std::string::npos ? 1 : 0;
  }
  CHECK(pictures == 4);
}

TEST_CASE("a friction that practice moves out of its own interval is told in one sentence, in numbers and on the page") {
  const Scratch folder;
  const nlohmann::json j = written(folder, with_rolling());
  const nlohmann::json& models = j["held_out"][0]["models"];
  const auto practice = std::find_if(models.begin(), models.end(), [](const auto& m) { return m["model"] == "retuned to power"; });
  std::vector<std::string> expected;
  for (const char* name : {"bead_friction", "wall_friction"}) {  // filling is no friction: practice leaves it as the case has it
    const nlohmann::json& all = j["contact_parameters"]["retuned"][name];
    const double value = (*practice)["parameters"][name], low = all["low90"], high = all["high90"];
    if (value < low || value > high)
      expected.push_back(
          fmt::format("{}: retuned to the power alone it is {:.3g}, outside its own interval ({:.3g} … {:.3g}): that moves it "
                      "where the recordings as a whole do not want it",
                      name, value, low, high));
  }
  REQUIRE_FALSE(expected.empty());
  CHECK(j["moved_by_practice"] == nlohmann::json(expected));
  for (const std::string& sentence : expected) CHECK_THAT(base::text_of(folder / "out/diagnosis.md"), Contains(sentence + ".\n"));
}

TEST_CASE("each number of a held-out condition has its distance from each model") {
  const Scratch folder;
  const nlohmann::json j = written(folder, with_rolling());
  const nlohmann::json& held = j["held_out"][0];
  for (const auto& model : held["models"]) {
    const std::string name = model["model"];
    double sum = 0;
    for (const auto& row : held["observables"]) {
      const double z = row["z"][name], difference = row["recorded"].get<double>() - row[name].get<double>();
      CHECK(z * difference >= 0);
      sum += z * z;
    }
    const double misfit = model["misfit"];  // counts how the numbers hang together, which z does not
    CHECK(sum / static_cast<double>(held["observables"].size()) > 0.1 * misfit);
    CHECK(sum / static_cast<double>(held["observables"].size()) < 10 * misfit);
  }
}

TEST_CASE("what the simulations give cause to doubt is told once, in numbers and on the page") {
  const Scratch folder;
  std::filesystem::create_directories(folder / "run");
  std::ofstream(folder / "run/summary.json") << R"json({"doubts": [{"name": "overlap", "of": "glass~liner (wall)", "value": 0.2,
    "limit": 0.05, "unit": "bead radii", "finding": "beads sink in", "may_change": "power", "remedy": "stiffer contacts"}]})json";
  const Question q = question_of(folder, "hypotheses: {rolling_resistance: {}}\nobserve: {beads: 300}\n");
  MadeUpMill mill(q, {{kRolling, 0, 0.2, 3, {21, 22, 23}}}, kBase);
  calibrate::Machinery machinery = mill.machinery();
  machinery.run = [&, run = machinery.run](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes = run(simulations);
    for (campaign::Outcome& o : outcomes) o.folder = folder / "run";
    return outcomes;
  };
  naming::Options options;
  options.draws = 240, options.comparison_draws = 160;
  const Diagnosis d = diagnose::diagnose(q, machinery, mill.evidence(), options);
  write_outputs({q, d}, folder / "out");
  const nlohmann::json j = nlohmann::json::parse(base::text_of(folder / "out/diagnosis.json"));
  REQUIRE(j["doubts"].size() == 1);
  CHECK(j["doubts"][0]["of"] == "glass~liner (wall)");
  CHECK(j["doubts"][0]["said_by"] == 1);
  CHECK(j["doubts"][0]["simulations"] == 1);
  CHECK_THAT(base::text_of(folder / "out/diagnosis.md"), Contains("Doubt: 1 of 1 simulations: beads sink in; power; stiffer contacts"));
}

TEST_CASE("corrected/ is a case with the physics on, and a study that can be diagnosed again") {
  const Scratch folder;
  const nlohmann::json j = written(folder, with_rolling());
  const std::filesystem::path file = folder / "out/corrected/case.yaml";
  const config::Case c = config::read_case(file.string());
  REQUIRE(c.contact.interactions.size() == 1);
  CHECK(c.contact.interactions[0].kind == "rolling_epsd");
  const std::vector<const Descriptor*> descriptors = registry().descriptors();
  config::finish(c, descriptors);
  const std::string resolved = config::resolved_yaml(c, descriptors);
  CHECK_THAT(resolved, Contains("rolling_friction"));
  const double friction = std::stod(c.pairs.section().at("glass~glass").at("static_friction").text());
  CHECK_THAT(friction, WithinRel(j["contact_parameters"]["unmasked"]["bead_friction"]["value"].get<double>(), 1e-3));
  const auto speed = [](const std::string& of, const std::vector<std::string>& settings) {
    return config::read_case(of, settings).mill->speed;
  };
  const std::string base = MILLSCOPE_SOURCE_DIR "/configs/mill10/case.yaml";
  CHECK(speed(file.string(), {"beads.glass10.diameter=12 mm"}) == speed(base, {}));  // the critical speed is not what it was
  const Question again = read_question(folder / "out/corrected/study.yaml", {}, registry());
  CHECK(again.study.conditions.size() == 3);
  CHECK(again.study.conditions[0].settings == std::vector<std::string>{fmt::format("mill.speed={} rad/s", again.speed[0])});
  CHECK(again.study.conditions[2].role == calibrate::Role::held_out);
  CHECK(again.study.parameters[1].name == "wall_friction");
  CHECK(again.study.observing.beads == 300);
  const BankSize& bank = again.bank;
  CHECK(std::array{bank.base, bank.each, bank.apart, bank.first} == std::array{26, 11, 9, 3});
  CHECK(bank.develop_turns == 0.5);
  REQUIRE(again.nuisances.size() == 1);
  CHECK_THAT(again.nuisances[0].sigma, WithinRel(0.00313, 1e-6));
  CHECK(std::none_of(again.candidates.begin(), again.candidates.end(), [](const Candidate& k) { return k.name == "rolling_resistance"; }));
}

TEST_CASE("a camera that was found to stand aside is where corrected/ goes on from") {
  const Scratch folder;
  const nlohmann::json j = written(folder, {kBase[0], kBase[1], "camera.frame_error.offset_x=0.0042"},
                                   "nuisances: {camera.frame_error.offset_x: {range: [-5 mm, 5 mm], sigma: 1 mm, name: axis_x}}\n", 0.4);
  REQUIRE(j["named"] == nlohmann::json({"axis_x"}));
  CHECK_THAT(base::text_of(folder / "out/corrected/case.yaml"), Contains("The mill behind axis_x"));
  const Question again = read_question(folder / "out/corrected/study.yaml", {}, registry());
  REQUIRE(again.nuisances.size() == 1);
  CHECK_THAT(again.nuisances[0].mean, WithinAbs(0.0042, 0.001));
  CHECK_THAT(again.nuisances[0].sigma, WithinRel(0.001, 1e-6));
}

TEST_CASE("a filling that was found beyond its range is where corrected/ goes on from") {
  const Scratch folder;
  const nlohmann::json j = written(folder, {kBase[0], kBase[1], "fill.filling=0.333"}, kFilling, 0.3);
  REQUIRE(j["named"] == nlohmann::json({"filling"}));
  const Question again = read_question(folder / "out/corrected/study.yaml", {}, registry());
  REQUIRE(again.nuisances.size() == 1);
  CHECK_THAT(again.nuisances[0].mean, WithinAbs(0.333, 0.002));
  CHECK_THAT(again.nuisances[0].low, WithinAbs(0.304, 1e-6));
  CHECK_THAT(again.nuisances[0].high, WithinAbs(0.340, 1e-6));  // as far as was simulated
  CHECK(again.nuisances[0].sigma >= 0.00313);
}

TEST_CASE("corrected/ has what was varied apart as it was fitted, and doubts it again") {
  const Scratch folder;
  // The mill is stiffer than the range allows for: the fit stands at its end, which the corrected case has then. It is so by a twentieth:
  // more of it, and the recording would not look like the model any more.
  const nlohmann::json j =
      written(folder, {kBase[0], kBase[1], "stiffness_factor=0.0105", kRolling + "=0.12"},
              "nuisances: {stiffness_factor: {range: [0.001, 0.0100004], mean: 0.004, sigma: 0.004, name: stiffness, apart: true}}\n", 0.4);
  REQUIRE(j["hypotheses"][0]["name"] == "rolling_resistance");
  const config::Case c = config::read_case((folder / "out/corrected/case.yaml").string());
  CHECK_THAT(c.stiffness_factor, WithinRel(j["contact_parameters"]["unmasked"]["stiffness"]["value"].get<double>(), 1e-3));
  CHECK(c.stiffness_factor > 0.002);
  const Question again = read_question(folder / "out/corrected/study.yaml", {}, registry());
  REQUIRE(again.nuisances.size() == 1);
  CHECK(again.nuisances[0].usual == c.stiffness_factor);
}

TEST_CASE("where nothing was found there is no corrected case, an older one goes") {
  const Scratch folder;
  std::filesystem::create_directories(folder / "out/corrected");
  const nlohmann::json j = written(folder, kBase);
  CHECK(j["verdict"] == "no_mismatch");
  CHECK(j["held_out"][0]["simulations"] == 0);
  for (const auto& model : j["held_out"][0]["models"]) CHECK(model["from"] == "surrogate");
  CHECK_THAT(base::text_of(folder / "out/diagnosis.md"),
             Contains("| predicted |") && Contains("No simulation beside the bank's was needed. *Predicted*"));
  CHECK_FALSE(j["contact_parameters"].contains("unmasked"));
  CHECK_FALSE(std::filesystem::exists(folder / "out/corrected"));
  CHECK(j["hypotheses"][0]["class"] == "not needed");
  // No interval was worked out, and none is pretended.
  const auto& strength = j["hypotheses"][0]["parameters"]["rolling_friction"];
  CHECK(strength["value"].is_number());
  CHECK(strength["low90"].is_null());
  CHECK(strength["high90"].is_null());
  CHECK(j["hypotheses"][0]["p_goodness"].is_null());
}
