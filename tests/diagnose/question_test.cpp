// study.yaml of a diagnosis: what is read, and what is refused with its place.
#include "studies/diagnose/question/question.hpp"

#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "made_up_study.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinAbs;
using Catch::WithinRel;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using testing::Scratch;

namespace {

/// The message for a study with these sections, from the file's name on; one line.
std::string refused(const std::string& sections) {
  const Scratch folder;
  const std::string message = testing::refusal([&] { question_of(folder, sections); });
  CHECK(message.find('\n') == std::string::npos);
  const std::size_t name = message.find("study.yaml:");
  return name == std::string::npos ? message : message.substr(name);
}

const Candidate& candidate(const Question& q, const std::string& name) {
  for (const Candidate& c : q.candidates) {
    if (c.name == name) return c;
  }
  throw std::runtime_error("no candidate " + name);
}

}  // namespace

TEST_CASE("a question reads as it is written") {
  const Scratch folder;
  const Question q =
      question_of(folder,
                  "nuisances:\n"
                  "  fill.filling: {range: [30.4 %, 32.2 %], mean: 31.0 %, sigma: 0.313 %, name: filling}\n"
                  "  geometry.liner.diameter: {range: [299 mm, 301 mm], sigma: 0.3 mm}\n"
                  "hypotheses:\n"
                  "  rolling_resistance: {range: [0, 0.1]}\n"
                  "  end_faces_at_rest: {}\n"
                  "  lining: {sentence: The liner is rubber., path: pairs.glass~liner.restitution, without: 0.55, range: [0.2, 0.55]}\n"
                  "  stiff: {sentence: Softer., equation: k, citation: us, set: {stiffness_factor: 0.002}}\n"
                  "bank: {base: 30, each: 12, apart: 14, first: 3}\n"
                  "power_error: 1 %\n");
  REQUIRE(q.nuisances.size() == 2);
  CHECK(q.nuisances[0].name == "filling");
  CHECK(q.nuisances[0].path == "fill.filling");
  CHECK_THAT(q.nuisances[0].mean, WithinRel(0.31, 1e-12));
  CHECK_THAT(q.nuisances[0].sigma, WithinRel(0.00313, 1e-12));
  CHECK(q.nuisances[1].name == "diameter");
  CHECK_THAT(q.nuisances[1].mean, WithinRel(0.3, 1e-12));
  CHECK_THAT(q.nuisances[1].low, WithinRel(0.299, 1e-12));
  REQUIRE(q.candidates.size() == 4);
  CHECK(candidate(q, "rolling_resistance").far == 0.1);
  CHECK(candidate(q, "end_faces_at_rest").on_or_off());
  const Candidate& lining = candidate(q, "lining");
  CHECK(lining.far == 0.2);
  CHECK(lining.range.low == 0);
  CHECK(lining.parameter == "restitution");
  CHECK(settings_of(lining, 0.5) == std::vector<std::string>{"pairs.glass~liner.restitution=0.375"});
  CHECK(candidate(q, "stiff").set == std::vector<std::string>{"stiffness_factor=0.002"});
  CHECK(candidate(q, "stiff").equation == "k");
  CHECK(q.bank.base == 30);
  CHECK(q.bank.each == 12);
  CHECK(q.bank.apart == 14);
  CHECK(q.bank.first == 3);
  CHECK(q.bank.develop_turns == 0);
  CHECK(q.study.power_error == 0.01);
  REQUIRE(q.speed.size() == 3);
  CHECK_THAT(q.speed[2] / q.speed[0], WithinRel(50.0 / 75, 1e-9));
  const std::vector<Coordinate> theta = q.coordinates();
  CHECK(theta[0].name == "bead_friction");
  CHECK_FALSE(theta[0].nuisance());
  CHECK(theta[2].nuisance());
}

TEST_CASE("a mill turns as recorded, also where larger beads would lower its critical speed") {
  const Scratch folder;
  const Question q = question_of(folder, "hypotheses: {size_spread: {}}\n");
  for (std::size_t condition = 0; condition < 3; ++condition) {
    const std::vector<std::string>& settings = q.study.conditions[condition].settings;
    std::vector<std::string> with = settings, in_percent{fmt::format("mill.speed={} %critical", std::array{75, 60, 50}.at(condition))};
    for (const std::string& s : settings_of(q.candidates[0], 1)) with.push_back(s), in_percent.push_back(s);
    const auto speed = [&](const std::vector<std::string>& of) {
      return std::fabs(config::read_case(q.study.base.string(), of).mill->speed);
    };
    CHECK(speed(settings) == q.speed[condition]);
    CHECK(speed(with) == q.speed[condition]);
    CHECK(speed(in_percent) > 1.005 * q.speed[condition]);
  }
}

TEST_CASE("every speed in % of critical is settled, of parts that turn by themselves as well, and no other") {
  const std::string base = MILLSCOPE_SOURCE_DIR "/configs/mill10/case.yaml";
  const auto settled = [&](const std::vector<std::string>& settings) { return speeds_settled(config::read_case(base, settings)); };
  CHECK(settled({"mill.speed=50 rpm"}).empty());
  CHECK(settled({}).size() == 1);
  const std::vector<std::string> apart{"mill.speed=50 rpm",
                                       "geometry.disc={kind: cylinder, diameter: 100 mm, length: 60 mm, material: liner}",
                                       "geometry.disc.motion={rotation: {speed: 40 %critical}}"};
  REQUIRE(settled(apart).size() == 1);
  std::vector<std::string> with = apart;
  with.push_back(settled(apart)[0]);
  const auto speed = [&](std::vector<std::string> settings, bool larger) {
    if (larger) settings.push_back("beads.glass10.diameter=12 mm");
    return config::read_case(base, settings).geometry.back().motion.rotation->speed;
  };
  CHECK(speed(apart, true) > 1.001 * speed(apart, false));
  CHECK(speed(with, true) == speed(apart, false));
}

TEST_CASE("without a map of hypotheses all that apply are asked, in alphabetical order, with the standards of the documentation") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  CHECK(q.candidates.size() >= 8);
  CHECK(std::is_sorted(q.candidates.begin(), q.candidates.end(), [](const auto& a, const auto& b) { return a.name < b.name; }));
  CHECK(q.bank.base == 24);
  CHECK(q.bank.each == 10);
  CHECK(q.bank.apart == 24);
  CHECK(q.study.power_error == 0.005);
  CHECK_FALSE(q.left_out.empty());
}

TEST_CASE("settings carry four digits, what is tied goes along, effects come last") {
  const Scratch folder;
  const Question q = question_of(folder,
                                 "nuisances: {fill.filling: {range: [30 %, 32 %], sigma: 0.3 %}}\n"
                                 "hypotheses: {rolling_resistance: {}}\n");
  const std::vector<std::string> s = q.settings((VectorXd(3) << 0.123456, 0.3, 0.31).finished(), {{0, 0.5}});
  CHECK(s[0] == "pairs.glass~glass.static_friction=0.1235");
  CHECK(s[1] == "pairs.glass~liner.static_friction=0.3");
  CHECK(s[2] == "fill.filling=0.31");
  CHECK(s[3] == "contact.interactions.rolling_epsd.kind=rolling_epsd");
  CHECK(s[4] == "pairs.glass~glass.rolling_friction=0.1");
  CHECK(s[5] == "pairs.glass~liner.rolling_friction=0.1");
}

TEST_CASE("two hypotheses that no case may have at once are not tried together") {
  const Scratch folder;
  const Question q = question_of(folder,
                                 "hypotheses:\n"
                                 "  short: {sentence: S., set: {time.end_s: 4}}\n"
                                 "  late: {sentence: L., set: {time.analyze_from_s: 4.5}}\n"
                                 "  rolling_resistance: {}\n");
  CHECK(candidate(q, "short").excludes.size() + candidate(q, "late").excludes.size() == 1);
  CHECK(candidate(q, "rolling_resistance").excludes == std::vector<std::string>{"rolling_friction", "bead_shape"});
  REQUIRE_FALSE(q.left_out.empty());
  CHECK_THAT(q.left_out.back(), Contains(" at once: ") && Contains("analyze_from_s"));
}

TEST_CASE("two that clash at their far ends only may be there at once") {
  const Scratch folder;  // both together leave no time to look at: 8 s less 3 s at first
  const Question q = question_of(folder,
                                 "hypotheses:\n"
                                 "  short: {sentence: S., path: time.end_s, without: 8, range: [4, 8]}\n"
                                 "  late: {sentence: L., path: time.analyze_from_s, without: 3, range: [3, 6]}\n");
  CHECK(candidate(q, "short").excludes.empty());
  CHECK(candidate(q, "late").excludes.empty());
}

TEST_CASE("friction and restitution may both hang on speed") {
  const Scratch folder;
  const Question q = question_of(folder,
                                 "hypotheses:\n"
                                 "  speed_dependent_friction: {}\n"
                                 "  speed_dependent_restitution: {set: {contact.pair_parameters.restitution_by_speed.form: plastic,\n"
                                 "    pairs.glass~glass.reference_restitution: 0.6, pairs.glass~liner.reference_restitution: 0.6}}\n");
  REQUIRE(q.candidates.size() == 2);
  for (const Candidate& c : q.candidates) CHECK(c.excludes.empty());
}

TEST_CASE("a hypothesis that lacks a value of the base takes it from 'set'") {
  CHECK_THAT(refused("hypotheses:\n  speed_dependent_restitution: {}\n"),
             StartsWith("study.yaml:10: 'hypotheses.speed_dependent_restitution' does not apply: needs pairs.glass~glass.reference_"));
  const Scratch folder;
  const Question q =
      question_of(folder,
                  "hypotheses:\n"
                  "  speed_dependent_restitution:\n"
                  "    set: {pairs.glass~glass.reference_restitution: 0.8, pairs.glass~liner.reference_restitution: 0.55}\n");
  const Candidate& c = candidate(q, "speed_dependent_restitution");
  CHECK_THAT(c.sentence, Contains("Fast impacts"));
  CHECK(c.paths.front() == "pairs.glass~glass.strength");
  REQUIRE(c.set.size() == 3);
  CHECK(c.set[0] == "contact.pair_parameters.restitution_by_speed.kind=restitution_by_speed");
  CHECK(c.set[1] == "pairs.glass~glass.reference_restitution=0.8");
  CHECK(
      std::none_of(q.left_out.begin(), q.left_out.end(), [](const std::string& line) { return line.starts_with("speed_dependent_res"); }));
  CHECK_FALSE(q.left_out.empty());
}

TEST_CASE("nuisances that cannot be are refused at their line") {
  const auto nuisance = [](const std::string& text) { return refused("nuisances:\n  fill.filling: " + text + "\n"); };
  CHECK_THAT(nuisance("31 %"), StartsWith("study.yaml:10: 'nuisances.fill.filling' is no nuisance; write e.g. {range:"));
  CHECK_THAT(nuisance("{range: [30 %], sigma: 1 %}"), StartsWith("study.yaml:10: ") && Contains("has 1 values; give the lower and the"));
  CHECK_THAT(nuisance("{range: [32 %, 30 %], sigma: 1 %}"), StartsWith("study.yaml:10: ") && Contains("turn them round"));
  CHECK_THAT(nuisance("{range: [30 %, 32 %]}"), StartsWith("study.yaml:10: ") && Contains("sigma") && Contains("standard deviation"));
  CHECK_THAT(nuisance("{range: [30 %, 32 %], sigma: 0}"), StartsWith("study.yaml:10: 'nuisances.fill.filling.sigma' is not above 0"));
  CHECK_THAT(nuisance("{range: [30 %, 32 %], sigma: -1 %}"), Contains("is not above 0; leave out what is known exactly"));
  CHECK_THAT(nuisance("{range: [30 %, 32 %], mean: 33 %, sigma: 1 %}"), Contains("mean 0.33 outside the range 0.3 … 0.32"));
  CHECK_THAT(nuisance("{range: [30 %, 32 %], sigm: 1 %}"), Contains("unknown key 'sigm'") && Contains("sigma"));
  CHECK_THAT(refused("nuisances:\n  pairs.glass~glass.static_friction: {range: [0.1, 0.6], sigma: 0.1}\n"),
             StartsWith("study.yaml:10: ") && Contains("is a parameter, too"));
}

TEST_CASE("a nuisance apart has one value in the case, which its range holds, and no candidate's, or it is refused at its line") {
  const auto apart = [](const std::string& range, const std::string& more = "") {
    return refused("nuisances:\n  stiffness_factor: {range: " + range + ", sigma: 0.002, apart: true}\n" + more);
  };
  CHECK_THAT(apart("[0.002, 0.01]"), StartsWith("study.yaml:10: ") && Contains("0.002 … 0.01 does not hold 0.001, which it is"));
  CHECK_THAT(apart("[0.001, 0.01]", "hypotheses:\n  contact_stiffness: {}\n"),
             StartsWith("study.yaml:12: ") && Contains("changes stiffness_factor, which is the nuisance 'stiffness_factor' already"));
  CHECK_THAT(refused("nuisances:\n  pairs.glass~glass.rolling_friction: {range: [0, 0.1], sigma: 0.1, apart: true}\n"),
             StartsWith("study.yaml:10: 'pairs.glass~glass.rolling_friction' is not in ") && Contains("write there what it is"));
  CHECK_THAT(refused("nuisances:\n  mill.speed: {range: [4, 10], sigma: 1, apart: true}\n"),
             StartsWith("study.yaml:10: ") && Contains("in condition 'speed75'") && Contains("give it one value in all"));
  CHECK_THAT(refused("nuisances:\n  mill.speed: {range: [70 %critical, 80 %critical], sigma: 1}\n"),
             StartsWith("study.yaml:10: ") && Contains("is in %critical, which depends on the case; give rad/s or rpm"));
  CHECK_THAT(refused("nuisances:\n  camera.frame_error.scale: {range: [-2 %, 2 %], sigma: 0.5 %, apart: true}\n"),
             StartsWith("study.yaml:10: ") && Contains("costs no simulation"));
  CHECK_THAT(apart("[0.001, 0.01]", "hypotheses:\n  soft: {sentence: Softer., set: {stiffness_factor: 0.002}}\n"),
             StartsWith("study.yaml:12: ") && Contains("changes stiffness_factor, which is the nuisance"));
  CHECK_THAT(refused("nuisances:\n  fill.filling: {range: [30 %, 32 %], sigma: 1 %, name: a}\n  stiffness_factor: {range: [0.001, 0.01], "
                     "sigma: 0.1, name: a}\n"),
             StartsWith("study.yaml:1") && Contains("there are two nuisances 'a'"));
  CHECK_THAT(refused("nuisances:\n  fill.filling: {range: [30 %, 32 %], sigma: 1 %, name: base}\n"),
             StartsWith("study.yaml:10: ") && Contains("give it another 'name'"));
  CHECK_THAT(refused("nuisances:\n  fill.filling: {range: [30 %, 32 %], sigma: 1 %, name: lifter_wear}\nhypotheses:\n  lifter_wear: {}\n"),
             StartsWith("study.yaml:12: ") && Contains("is the name of a nuisance, too"));
  const Scratch folder;
  const Question all = question_of(folder, "nuisances: {stiffness_factor: {range: [0.001, 0.01], sigma: 0.002, apart: true}}\n");
  CHECK(std::any_of(all.left_out.begin(), all.left_out.end(), [](const std::string& s) { return s.starts_with("contact_stiffness:"); }));
  CHECK(all.coordinates()[2].usual == 0.001);
}

TEST_CASE("of the camera its frame alone may be doubted, in units that fit, or it is refused at its line") {
  const Scratch folder;
  const Question q =
      question_of(folder, "nuisances:\n  camera: {frame_error: {tilt_z: {range: [-3 deg, 3 deg], sigma: 10 mrad, name: level}}}\n");
  REQUIRE(q.nuisances.size() == 1);
  CHECK(q.nuisances[0].of_camera());
  CHECK_THAT(q.nuisances[0].sigma, WithinRel(0.01, 1e-12));
  VectorXd theta(3);
  theta << 0.3, 0.4, 0.02;
  CHECK_THAT(q.camera(theta), Contains("{kind: frame_error, tilt_z: 0.02}"));
  for (const std::string& setting : q.settings(theta, {})) CHECK_THAT(setting, !StartsWith("camera"));
  const auto camera = [](const std::string& path, const std::string& range) {
    return refused("nuisances: {" + path + ": {range: " + range + ", sigma: 1e-3, name: off}}\n");
  };
  for (const char* path : {"camera.frame_error", "camera.error_cut.per_speed", "camera.frame_error.offset", "camera.frame_error.tilt_z.x"})
    CHECK_THAT(camera(path, "[-1, 1]"), StartsWith("study.yaml:9: ") && Contains("write camera.frame_error.NAME with one of offset_x, "));
  CHECK_THAT(camera("camera.frame_error.offset_x", "[-1, 50]"), StartsWith("study.yaml:9: nuisance 'off': ") && Contains("50"));
  CHECK_THAT(camera("camera.frame_error.tilt_z", "[-10 mm, 10 mm]"), StartsWith("study.yaml:9: ") && Contains("mm"));
}

TEST_CASE("hypotheses that cannot be are refused at their line") {
  const auto hypothesis = [](const std::string& text) { return refused("hypotheses:\n  " + text + "\n"); };
  CHECK_THAT(hypothesis("roling: {}"), StartsWith("study.yaml:10: 'hypotheses.roling' is no hypothesis of a loaded plugin; known: ") &&
                                           Contains("rolling_resistance") && Contains("or give it a 'path'"));
  CHECK_THAT(hypothesis("rolling_resistance: {rang: [0, 1]}"), StartsWith("study.yaml:10: ") && Contains("did you mean 'range'?"));
  CHECK_THAT(hypothesis("rolling_resistance: {range: [0.05, 0.2]}"),
             StartsWith("study.yaml:10: 'hypotheses.rolling_resistance.range' does not hold 0, where it vanishes"));
  CHECK_THAT(hypothesis("own: {path: a.b, without: 0, range: [0, 1]}"), StartsWith("study.yaml:10: ") && Contains("has no 'sentence'"));
  CHECK_THAT(hypothesis("own: {sentence: S., path: a.b, range: [0, 1]}"), StartsWith("study.yaml:10: ") && Contains("without"));
  CHECK_THAT(hypothesis("own: {sentence: S., path: a.b, without: 0}"), StartsWith("study.yaml:10: ") && Contains("no 'range'"));
  CHECK_THAT(hypothesis("own: {sentence: S., path: a.b, without: 0, range: [0.2, 1]}"), Contains("does not hold 0"));
  CHECK_THAT(hypothesis("own: {sentence: S., set: {a.b: 1}, range: [0, 1]}"),
             StartsWith("study.yaml:10: ") && Contains("has no 'path' that takes its values"));
  CHECK_THAT(hypothesis("location_blur: {}"), StartsWith("study.yaml:10: ") && Contains("does not apply: an effect of the camera"));
  CHECK_THAT(refused("hypotheses: all\n"), StartsWith("study.yaml:9: 'hypotheses'"));
}

TEST_CASE("what no value of the case stands behind is refused before anything is simulated") {
  CHECK_THAT(refused("hypotheses:\n  own: {sentence: S., path: pairs.glass~glass.static_fricton, without: 0, range: [0, 1]}\n"),
             StartsWith("study.yaml:10: hypothesis 'own'") && Contains("static_friction"));
  CHECK_THAT(refused("hypotheses:\n  own: {sentence: S., path: pairs.glass~glass.restitution, without: 0.8, range: [0.8, 1.8]}\n"),
             StartsWith("study.yaml:10: hypothesis 'own'") && Contains("1.8"));
  CHECK_THAT(refused("nuisances:\n  fill.fillin: {range: [30 %, 32 %], sigma: 1 %}\n"),
             StartsWith("study.yaml:10: nuisance 'fillin'") && Contains("filling"));
  CHECK_THAT(refused("nuisances:\n  fill.filling: {name: again, range: [30 %, 32 %], sigma: 1 %}\n"),
             StartsWith("study.yaml:10: nuisance 'again'") && Contains("group of the bank"));
  CHECK_THAT(refused("hypotheses:\n  base: {sentence: It is so., path: pairs.glass~glass.restitution, without: 0.8, range: [0.2, 0.8]}\n"),
             StartsWith("study.yaml:10: hypothesis 'base'") && Contains("group of the bank"));
}

TEST_CASE("a parameter that gives no case is refused before anything is simulated") {
  const Scratch folder;
  const std::filesystem::path file = write_study(folder, "");
  const auto message = [&](const std::string& setting) { return testing::refusal([&] { read_question(file, {setting}, registry()); }); };
  CHECK_THAT(message("parameters.pairs.glass~glass.restitution.range=[0.5, 3]"),
             Contains("parameters in the middle of their ranges") && Contains("1.75"));
}

TEST_CASE("a bank and an error of power that cannot be are refused at their line") {
  CHECK_THAT(refused("bank: {base: 4}\n"), StartsWith("study.yaml:9: 'bank.base'") && Contains("8"));
  CHECK_THAT(refused("bank: {apart: 7}\n"), StartsWith("study.yaml:9: 'bank.apart'") && Contains("8"));
  CHECK_THAT(refused("bank: {each: 0}\n"), StartsWith("study.yaml:9: 'bank.each'"));
  CHECK_THAT(refused("bank: {each: 2.5}\n"), StartsWith("study.yaml:9: 'bank.each'"));
  CHECK_THAT(refused("bank: {total: 100}\n"), StartsWith("study.yaml:9: ") && Contains("unknown key 'total'"));
  CHECK_THAT(refused("power_error: -1 %\n"), StartsWith("study.yaml:9: 'power_error'"));
  CHECK_THAT(refused("power_error: 5\n"), StartsWith("study.yaml:9: 'power_error'"));
  CHECK_THAT(refused("power_error: much\n"), StartsWith("study.yaml:9: 'power_error'"));
}

TEST_CASE("a study may say how often a false alarm is allowed") {
  const Scratch folder;
  CHECK(question_of(folder, "").level == 0.05);
  CHECK(question_of(folder, "level: 1 %\n").level == Approx(0.01));
  CHECK_THAT(refused("level: 0.5\n"), StartsWith("study.yaml:9: ") && Contains("'level'") && Contains("false alarm"));
}
