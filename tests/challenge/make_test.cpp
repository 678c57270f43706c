// One tiny make: two sets of a small mill, half a second each.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "kernel/base/text.hpp"
#include "studies/calibrate/bead_paths.hpp"
#include "studies/challenge/answer.hpp"
#include "studies/challenge/concealment.hpp"
#include "studies/challenge/draw.hpp"
#include "studies/challenge/make.hpp"
#include "studies/challenge/run.hpp"
#include "studies/recording/recording.hpp"
#include "tests/scratch.hpp"

using namespace millscope;
using namespace millscope::challenge;

namespace {

namespace fs = std::filesystem;

const std::string kStudy = R"(
base: )" MILLSCOPE_SOURCE_DIR R"(/configs/demo.yaml
conditions:
  fast:
    set: {beads.glass5.diameter: 10 mm, geometry.liner.length: 40 mm, fill.vessel.length: 40 mm, domain.periodic.z: [0, 40 mm], time.analyze_from_s: 0.05}
    recording: still_to_be_made.yaml
    role: fit
parameters:
  pairs.glass~glass.static_friction: {name: bead_friction, range: [0.1, 0.6]}
nuisances:
  fill.filling: {name: filling, range: [38 %, 42 %], mean: 39.5 %, sigma: 0.4 %}
hypotheses: {lifter_wear: {}}
)";

const std::string kChallenge = R"(
study: study.yaml
camera: camera.yaml
seed: 4
truth: {set: {contact.law.cap: sum, stiffness_factor: 0.001}}
beads: 6
seconds: 0.4
sets: [{kind: none}, {kind: effect, hypothesis: lifter_wear, strength: [0.5, 0.9]}]
)";

struct Made {
  testing::Scratch folder;
  host::Registry registry;
  Challenge challenge;
  fs::path sets = folder / "sets";

  Made() {
    std::ofstream(folder / "study.yaml") << kStudy;
    std::ofstream(folder / "camera.yaml")
        << "schema_version: 1\nobservations: {rate: {kind: sampling, rate: 300 Hz}, noise: {kind: noise, white: [0.4, 0.4, 0.4, mm]}}\n";
    std::ofstream(folder / "c.yaml") << kChallenge;
    challenge = read_challenge(folder / "c.yaml");
  }
  void make_sets() {
    MakeOptions options{sets, {}, {}};
    options.campaign.program = fs::path(MILLSCOPE_BINARY_DIR) / "bin" / "millscope";
    options.campaign.quiet = true;
    make(challenge, question_of(challenge, registry), registry, options);
  }
};

}  // namespace

TEST_CASE("sets are recordings of drawn mills, and tell nothing of what was drawn") {
  Made made;
  made.make_sets();
  const std::vector<Answer> answers = open_answers(made.sets);
  REQUIRE(answers.size() == 2);
  int effects = 0;
  for (const Answer& a : answers) {
    effects += a.kind == challenge::Kind::effect ? 1 : 0;
    CHECK(a.theta[0].second > 0.1 + 0.15 * 0.5 - 1e-3);
    CHECK(a.theta[0].second < 0.6 - 0.15 * 0.5 + 1e-3);
    const fs::path recording = made.sets / a.set / "r_fast.yaml";
    const recording::Recording r = recording::read_recording(recording);
    CHECK(r.runs.size() == 6);
    CHECK(*r.condition.filling == Approx(0.395));  // as believed
    CHECK(r.condition.geometry.empty());
    REQUIRE(r.condition.slice);
    CHECK(r.condition.slice->low == Approx(0).margin(1e-12));
    CHECK(r.condition.slice->high == Approx(0.04));
    CHECK(r.condition.power->value == Approx(a.made.at("fast").at("measured_power_W").get<double>()));
    for (const auto& file : fs::directory_iterator(made.sets / a.set)) {
      const std::string text = base::text_of(file.path());
      for (const char* word : {"lifter", "seed", "cache", "friction", "stiffness", "answers"}) CHECK(text.find(word) == std::string::npos);
    }
  }
  CHECK(effects == 1);
  CHECK_NOTHROW(diagnose::read_question(made.sets / "set_001" / "study.yaml", {}, made.registry));
  CHECK(testing::refusal([&] { made.make_sets(); }).find("holds sealed sets already") != std::string::npos);
}

TEST_CASE("long runs say what the practice would have seen of each set, once") {
  Made made;
  std::ofstream(made.folder / "c.yaml") << std::string(kChallenge)
                                               .replace(
                                                   kChallenge.find("kind: none}, {"), 14,
                                                   "kind: none, count: 2}, {kind: decoy, name: fuller, set: {fill.filling: 41.5 %}}, {");
  made.challenge = read_challenge(made.folder / "c.yaml");
  made.make_sets();
  const std::string diagnosis =
      R"({"schema_version": 2, "verdict": "no_mismatch", "named": [], "hypotheses": [], "contact_parameters":
{"retuned": {"bead_friction": {"value": 0.3, "low90": 0.2, "high90": 0.4}, "filling": {"value": 0.4, "low90": 0.39, "high90": 0.41}}}, "held_out":
[{"condition": "held", "models": [{"model": "retuned to power", "parameters": {"bead_friction": 0.12, "filling": 0.395}}]}]})";
  for (const Answer& a : open_answers(made.sets)) {
    fs::create_directories(made.sets / a.set / "diagnosis");
    std::ofstream(made.sets / a.set / "diagnosis" / "diagnosis.json") << diagnosis;
  }
  ConcealOptions options{0.5, {}};
  options.campaign.cache = made.folder / "cache", options.campaign.program = fs::path(MILLSCOPE_BINARY_DIR) / "bin" / "millscope";
  options.campaign.quiet = true;
  const diagnose::Question q = question_of(made.challenge, made.registry);
  conceal(q, made.sets, made.registry, options);
  const std::vector<Marked> marked = read_sets(made.sets);
  for (const Marked& m : marked) {
    CHECK(m.practice.to_power.has_value() == (m.answer.kind != challenge::Kind::decoy));  // it has nothing to conceal
    if (m.answer.kind == challenge::Kind::decoy) continue;
    for (const std::optional<Concealment>& c : {m.practice.to_power, m.practice.to_all}) {
      REQUIRE(c);
      CHECK(std::fabs(c->power_percent) > 0);
      CHECK(std::fabs(c->power_percent) < 60);
      CHECK(std::isfinite(c->toe_deg));
      CHECK(c->chagas > 0.05);
    }
    CHECK(m.practice.to_power->power_percent != m.practice.to_all->power_percent);
  }
  const std::string before = base::text_of(made.sets / "concealment.json");
  nlohmann::json old = nlohmann::json::parse(before);
  old["schema_version"] = 1;
  for (auto& [set, seen] : old["sets"].items()) seen = nlohmann::json(seen["to_power"]);
  std::ofstream(made.sets / "concealment.json") << old;
  conceal(q, made.sets, made.registry, options);
  CHECK(base::text_of(made.sets / "concealment.json") == before);
  ConcealOptions longer = options;
  longer.seconds = 1;
  CHECK_THROWS_WITH(conceal(q, made.sets, made.registry, longer), Catch::Contains("0.5 s at 'fast'") && Catch::Contains("--seconds 0.5"));
  fs::remove_all(made.folder / "cache");
  conceal(q, made.sets, made.registry, options);
  CHECK(base::text_of(made.sets / "concealment.json") == before);
  CHECK_FALSE(fs::exists(made.folder / "cache"));
}

TEST_CASE("long runs of before tell of the base that was retuned to power") {
  const testing::Scratch folder;
  std::ofstream(folder / kConcealmentFile) << R"({"schema_version": 1, "condition": "fast", "seconds": 40, "sets": {"set_001":
{"power_percent": 0.5, "shoulder_deg": -1, "toe_deg": 2, "chagas2015": 0.3}, "set_002":
{"power_percent": null, "shoulder_deg": null, "toe_deg": null, "chagas2015": null}}})";
  const std::map<std::string, Practice> found = read_concealment(folder.path);
  REQUIRE(found.at("set_001").to_power);
  CHECK(found.at("set_001").to_power->toe_deg == 2);
  CHECK_FALSE(found.at("set_001").to_all);
  CHECK(std::isnan(found.at("set_002").to_power->power_percent));
}

TEST_CASE("concealed is what power, angles and distributions leave unsuspicious") {
  std::vector<Marked> sets;
  for (int i = 1; i <= 11; ++i) sets.push_back({{"e", challenge::Kind::none, "", {}, {}, {}}, {}, {Concealment{0, 0, 0, 0.1 * i}, {}}, ""});
  const std::string peers = sets.front().peers();
  const Unsuspicious limits = unsuspicious(sets, &Practice::to_power).at(peers);
  CHECK(std::isinf(unsuspicious(sets, &Practice::to_all).at(peers).chagas));
  CHECK(limits.chagas == Approx(1.0));
  CHECK(limits.holds({0.9, -1.4, 1.4, 0.9}));
  CHECK_FALSE(limits.holds({-1.1, 0, 0, 0.9}));
  CHECK_FALSE(limits.holds({0, 1.6, 0, 0.9}));
  CHECK_FALSE(limits.holds({0, 0, -1.6, 0.9}));
  CHECK_FALSE(limits.holds({0, 0, 0, 1.1}));
  CHECK_FALSE(limits.holds({0, 0, std::nan(""), 0.9}));
  sets.resize(9);
  CHECK(std::isinf(unsuspicious(sets, &Practice::to_power).at(peers).chagas));
}

TEST_CASE("only sets that were recorded alike tell what practice would not suspect") {
  const auto recorded = [](const std::string& end, const std::string& engine, double chagas) {
    const nlohmann::ordered_json settings = {"time.end_s=4", "run.engine=" + engine, "time.end_s=" + end, "output.tracks={beads: 60}"};
    return Marked{{"e", challenge::Kind::none, "", {}, {}, {{"fast", {{"settings", settings}}}}}, {}, {Concealment{0, 0, 0, chagas}, {}}};
  };
  std::vector<Marked> sets;
  for (int i = 1; i <= 10; ++i) {
    sets.push_back(recorded("11", "millscope", 1));
    sets.push_back(recorded("61", "millscope", 0.5));
    sets.push_back(recorded("11", "liggghts", 2));
  }
  CHECK(sets[0].setting("time.end_s") == "11");
  CHECK(sets[2].engine() == "liggghts");
  const auto limits = unsuspicious(sets, &Practice::to_power);
  REQUIRE(limits.size() == 3);
  CHECK(limits.at(sets[0].peers()).chagas == Approx(1));
  CHECK(limits.at(sets[1].peers()).chagas == Approx(0.5));
  CHECK(limits.at(sets[2].peers()).chagas == Approx(2));
}

TEST_CASE("sets that could not be read back are not sealed") {
  Made made;
  std::string study = kStudy;
  study.insert(study.find("time.analyze_from_s"), "materials.glass.density: 20 kg/m^3, time.step_fraction: 10 %, ");
  std::ofstream(made.folder / "study.yaml") << study;
  CHECK_THROWS_WITH(made.make_sets(), Catch::Contains("r_fast.yaml") && Catch::Contains("bead_density"));
  CHECK_FALSE(fs::exists(made.sets / "manifest.json"));
}

TEST_CASE("a mill that cannot be put together is refused before any is simulated") {
  Made made;
  std::string text = kChallenge;
  text.insert(text.rfind(']'), ", {kind: outside, name: long_beads, set: {beads.glass5.diameter: 15 mm}}");
  std::ofstream(made.folder / "c.yaml") << text;
  made.challenge = read_challenge(made.folder / "c.yaml");
  CHECK_THROWS_WITH(made.make_sets(), Catch::Contains("set_00") && Catch::Contains("lengthen the slice"));
  CHECK_FALSE(fs::exists(made.sets / "answers" / "cache"));
}

TEST_CASE("a nuisance apart is in every truth what the challenge makes it, or the set itself") {
  Made made;
  std::string study = kStudy, text = kChallenge;
  study.replace(study.find("hypotheses"), 0, "  stiffness_factor: {range: [0.00005, 0.01], mean: 0.002, sigma: 0.002, apart: true}\n");
  text.replace(text.find("{kind: none}"), 0, "{kind: outside, name: softer, set: {stiffness_factor: 0.0001}}, ");
  std::ofstream(made.folder / "study.yaml") << study;
  std::ofstream(made.folder / "c.yaml") << text;
  const Challenge c = read_challenge(made.folder / "c.yaml");
  const diagnose::Question q = question_of(c, made.registry);
  REQUIRE(q.nuisances.back().usual);
  for (const Truth& t : draw_truths(c, q)) CHECK(t.theta[2] == (t.kind == challenge::Kind::outside ? 0.0001 : 0.001));
}

TEST_CASE("a decoy is made with what it sets, and its answer says so") {
  Made made;
  std::string text = kChallenge;
  text.replace(text.find("{kind: none}"), std::string("{kind: none}").size(),
               "{kind: decoy, name: fuller, set: {fill.filling: 45 %}}, {kind: decoy, name: noisy, camera: noisy.yaml}");
  std::ofstream(made.folder / "noisy.yaml") << "observations: {}\n";
  std::ofstream(made.folder / "c.yaml") << text;
  Challenge c = read_challenge(made.folder / "c.yaml");
  const diagnose::Question q = question_of(c, made.registry);
  for (const Truth& t : draw_truths(c, q)) {
    CHECK((t.name == "fuller" ? t.theta[1] == 0.45 : t.theta[1] < 0.42));
    CHECK(t.camera.filename() == (t.name == "noisy" ? "noisy.yaml" : "camera.yaml"));
    const std::vector<std::string> settings = simulation_of(c, q, t, 0, "").settings;
    const auto set_there = std::find(settings.begin(), settings.end(), "fill.filling=45 %");
    CHECK((set_there != settings.end()) == (t.name == "fuller"));
  }
  c.sets[0].settings = {"pairs.glass~glass.restitution=0.3"};
  CHECK(testing::refusal([&] {
          question_of(c, made.registry);
        }).find("which is no parameter or drawn nuisance of the study by itself: that is no decoy") != std::string::npos);
}

TEST_CASE("a held-out condition is recorded for as long as the challenge asks") {
  Made made;
  std::string study = kStudy;
  study.replace(study.find("parameters:"), 0,
                "  slow: {set: {mill.speed: 50 %critical, time.analyze_from_s: 0.05}, recording: still_to_be_made.yaml, role: held_out}\n");
  std::ofstream(made.folder / "study.yaml") << study;
  std::ofstream(made.folder / "c.yaml") << kChallenge << "held_out_seconds: 0.7\n";
  for (const auto& [overrides, held_out] : std::map<std::string, double>{{"", 0.7}, {"held_out_seconds=2", 2}}) {
    const Challenge c = read_challenge(made.folder / "c.yaml", overrides.empty() ? std::vector<std::string>{} : std::vector{overrides});
    const diagnose::Question q = question_of(c, made.registry);
    const Truth t = draw_truths(c, q).front();
    for (std::size_t k = 0; k < 2; ++k) {
      const campaign::Simulation s = simulation_of(c, q, t, k, "");
      const double end = config::read_case(s.case_file.string(), s.settings).time.end;
      CHECK(end == Approx(0.05 + (q.study.conditions[k].role == calibrate::Role::held_out ? held_out : 0.4)));
    }
  }
}

TEST_CASE("longer held-out recordings are refused where nothing is held out") {
  Made made;
  std::ofstream(made.folder / "c.yaml") << kChallenge << "held_out_seconds: 0.7\n";
  const Challenge c = read_challenge(made.folder / "c.yaml");
  CHECK(testing::refusal([&] { question_of(c, made.registry); }).find("holds no condition out") != std::string::npos);
}

TEST_CASE("a set whose diagnosis throws is noted, and the others are tried") {
  Made made;
  seal(made.sets, {{"set_001", challenge::Kind::none, "", {}, {}, {}}, {"set_002", challenge::Kind::none, "", {}, {}, {}}},
       made.folder / "study.yaml");
  const RunCount count = challenge::run(made.sets, made.registry, {}, {});
  CHECK(count.failed == 2);
  CHECK(base::text_of(made.sets / "set_002" / "diagnosis" / "failed.txt").find("study.yaml: no such file") != std::string::npos);
  fs::create_directories(made.sets / "set_001" / "diagnosis");
  std::ofstream(made.sets / "set_001" / "diagnosis" / "diagnosis.json") << "{}";
  CHECK(challenge::run(made.sets, made.registry, {}, {}).known == 1);
}

TEST_CASE("hypotheses that the study does not have are refused") {
  Made made;
  made.challenge.sets[1].hypotheses = {"lifter_waer"};
  CHECK(testing::refusal([&] { question_of(made.challenge, made.registry); }).find("'lifter_waer' is no hypothesis of the study") !=
        std::string::npos);
  made.challenge.sets[1].hypotheses = {"lifter_wear"};
  made.challenge.sets[1].low = -0.5;
  CHECK(testing::refusal([&] { question_of(made.challenge, made.registry); }).find("leaves its range") != std::string::npos);
}

TEST_CASE("what a hypothesis stands for is not set beside it") {
  Made made;
  made.challenge.truth.emplace_back("geometry.liner.lifter_height=5 mm");
  CHECK(testing::refusal([&] {
          question_of(made.challenge, made.registry);
        }).find("c.yaml:5: sets 'geometry.liner.lifter_height', which") != std::string::npos);
  made.challenge.truth.back() = "pairs.glass~glass.static_friction=0.2";
  CHECK(testing::refusal([&] { question_of(made.challenge, made.registry); }).find("which the study looks for") != std::string::npos);
  made.challenge.truth.pop_back();
  CHECK_NOTHROW(question_of(made.challenge, made.registry));
  made.challenge.sets[1].settings = {"geometry.liner.lifter_height=5 mm"};
  CHECK(testing::refusal([&] {
          question_of(made.challenge, made.registry);
        }).find("c.yaml:8: sets 'geometry.liner.lifter_height', which") != std::string::npos);
}

TEST_CASE("the power of a mill with one heavy tracer is that of the charge without it") {
  Made made;
  std::string study = kStudy, text = kChallenge;
  study.replace(study.find("{lifter_wear: {}}"), std::string("{lifter_wear: {}}").size(), "{unlike_tracer: {}}");
  text.replace(text.find("sets: ["), std::string::npos, "sets: [{kind: effect, hypothesis: unlike_tracer, strength: [1, 1]}]\n");
  std::ofstream(made.folder / "study.yaml") << study;
  std::ofstream(made.folder / "c.yaml") << text;
  made.challenge = read_challenge(made.folder / "c.yaml");
  made.make_sets();
  const Answer a = open_answers(made.sets).at(0);
  const fs::path run = made.sets / "answers" / "cache" / a.made.at("fast").at("run").get<std::string>() / "run";
  const double all = nlohmann::json::parse(base::text_of(run / "summary.json"))["power_W"]["com"];
  // One bead in twenty of twice the density adds a twentieth, where its like are as far from the axis; they need not be.
  const double ratio = a.made.at("fast").at("power_W").get<double>() / all;
  CHECK(ratio == Approx(1 / 1.05).margin(0.04));
  CHECK(ratio == Approx(calibrate::BeadPaths(run, 1, {}, made.registry).power_ratio()));
}
