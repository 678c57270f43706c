#include "studies/challenge/make.hpp"

#include <fmt/format.h>

#include <map>

#include "kernel/output/file.hpp"
#include "studies/challenge/answer.hpp"
#include "studies/challenge/draw.hpp"
#include "studies/challenge/record.hpp"
#include "studies/engine/engine.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using Json = nlohmann::ordered_json;

std::string set_name(std::size_t i) { return fmt::format("set_{:03}", i + 1); }

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

/// The study is included, so that all sets have one bank.
std::string study_text(const diagnose::Question& q, const fs::path& folder) {
  const fs::path study = fs::absolute(q.study.file).lexically_proximate(fs::absolute(folder));
  std::string out = fmt::format("# Recordings of a mill whose physics is not told: which was left out?\ninclude: [{}]\n\nconditions:\n",
                                quoted(study.string()));
  for (const calibrate::Condition& c : q.study.conditions) out += fmt::format("  {}: {{recording: r_{}.yaml}}\n", c.name, c.name);
  return out;
}

TrueEffect true_effect(const diagnose::Candidate& c, double strength) {
  if (c.on_or_off()) return {c.name, strength, "strength", strength, 0, 1};
  return {c.name, strength, c.parameter, diagnose::rounded(c.value(strength)), c.null_value, c.far};
}

Answer answer_of(const diagnose::Question& q, const Truth& truth, const std::string& set) {
  Answer a{set, truth.kind, truth.name, {}, {}, Json::object()};
  for (const naming::ActiveCandidate& e : truth.effects) a.effects.push_back(true_effect(q.candidates[e.candidate], e.strength));
  const std::vector<naming::Coordinate> coordinates = q.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) a.theta.emplace_back(coordinates[i].name, truth.theta[static_cast<Eigen::Index>(i)]);
  return a;
}

struct Maker {
  const Challenge& challenge;
  const diagnose::Question& question;
  const host::Registry& registry;
  const fs::path& output;
  std::map<fs::path, camera::Camera> cameras;

  /// One condition of a set: what the camera and the meter make of the truth.
  Json record(const Truth& truth, std::size_t condition, const campaign::Outcome& outcome, const fs::path& folder) const {
    base::RandomStream random = random_of(challenge, truth, condition);
    random.bits();  // the run's own seed
    const std::uint64_t camera_seed = random.bits();
    const PowerOfRun power = power_of(outcome.folder, registry);
    const double measured = power.value * (1 + question.study.power_error * random.normal());
    RecordingOf what{outcome.folder, folder, "r_" + question.study.conditions[condition].name, believed(question, condition, registry),
                     camera_seed};
    what.condition.power = recording::MeasuredPower{measured, power.sem};
    write_recording(what, cameras.at(truth.camera), registry);
    return {{"power_W", power.value}, {"measured_power_W", measured}, {"camera_seed", camera_seed}, {"run", outcome.key}};
  }
};

/// Before the first is simulated: a mill that cannot be put together spoils all sets.
void require_playable(const std::vector<campaign::Simulation>& simulations, const host::Registry& registry) {
  for (const campaign::Simulation& s : simulations) {
    try {
      engine::require_playable(config::read_case(s.case_file.string(), s.settings), registry);
    } catch (const UserError& e) {
      throw UserError(fmt::format("{}: {}", s.label, e.what()));
    }
  }
}

void refuse_failed(const std::vector<campaign::Simulation>& simulations, const std::vector<campaign::Outcome>& outcomes) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].state == campaign::State::failed)
      throw UserError(fmt::format("{}: its truth cannot be simulated: {}; correct the challenge and start again, nothing is computed twice",
                                  simulations[i].label, outcomes[i].message));
  }
}

}  // namespace

void make(const Challenge& challenge, const diagnose::Question& question, const host::Registry& registry, MakeOptions options) {
  const auto say = [&](const std::string& line) {
    if (options.say) options.say(line);
  };
  if (fs::exists(options.output / "manifest.json"))
    throw UserError(fmt::format("{}: holds sealed sets already; choose another folder", options.output.string()));
  const std::vector<Truth> truths = draw_truths(challenge, question);
  Maker maker{challenge, question, registry, options.output, {}};
  for (const Truth& truth : truths) {
    if (!maker.cameras.contains(truth.camera)) maker.cameras.emplace(truth.camera, camera::read_camera(truth.camera, registry));
  }
  const std::size_t conditions = question.study.conditions.size();
  std::vector<campaign::Simulation> simulations;
  for (std::size_t t = 0; t < truths.size(); ++t) {
    for (std::size_t c = 0; c < conditions; ++c)
      simulations.push_back(
          simulation_of(challenge, question, truths[t], c, fmt::format("{}, {}", set_name(t), question.study.conditions[c].name)));
  }
  require_playable(simulations, registry);
  fs::create_directories(options.output / "answers");
  if (options.campaign.cache.empty()) options.campaign.cache = options.output / "answers" / "cache";
  const std::string longer =
      challenge.held_out_seconds == challenge.seconds ? "" : fmt::format(", held out {:.4g} s", challenge.held_out_seconds);
  say(fmt::format("{} sets of {} conditions, {:.4g} s each{}", truths.size(), conditions, challenge.seconds, longer));
  const std::vector<campaign::Outcome> outcomes = campaign::run(simulations, options.campaign);
  refuse_failed(simulations, outcomes);
  std::vector<Answer> answers;
  for (std::size_t t = 0; t < truths.size(); ++t) {
    const fs::path folder = options.output / set_name(t);
    fs::remove_all(folder);
    fs::create_directories(folder);
    Answer answer = answer_of(question, truths[t], set_name(t));
    for (std::size_t c = 0; c < conditions; ++c) {
      Json& made = answer.made[question.study.conditions[c].name];
      made = maker.record(truths[t], c, outcomes[t * conditions + c], folder);
      made["settings"] = simulations[t * conditions + c].settings;
      made["camera"] = truths[t].camera.filename().string();
    }
    output::write_file(folder / "study.yaml", study_text(question, folder));
    answers.push_back(std::move(answer));
    say(fmt::format("made {}", folder.string()));
  }
  seal(options.output, answers, question.study.file);
}

}  // namespace millscope::challenge
