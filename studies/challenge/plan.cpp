#include "studies/challenge/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "kernel/base/nearest.hpp"
#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;
using config::between;
using config::Node;

constexpr int kMostSets = 999;
constexpr int kMostBeads = 100000;

std::vector<std::string> settings_of(const Node& set) {
  if (!set.is_map()) set.fail("is no map; write e.g. {stiffness_factor: 0.01}");
  return calibrate::settings_below(set);
}

Kind read_kind(const Node& node) {
  const std::string kind = config::read_choice(node, "none|effect|two|outside|decoy");
  return *std::find_if(std::begin(kKinds), std::end(kKinds), [&](Kind k) { return kind == name_of(k); });
}

void read_strength(const Node& node, SetsOf& sets) {
  const std::vector<Node> ends = node.items();
  if (ends.size() != 2) node.fail(fmt::format("has {} values; give the least and the largest strength, e.g. [0.3, 1]", ends.size()));
  const auto range = between(-1, 1, "as a part of the prior range");
  sets.low = config::read_number(ends[0], "1", range);
  sets.high = config::read_number(ends[1], "1", range);
  if (!(sets.low <= sets.high)) node.fail("has its lower end above the upper one; turn them round");
}

void read_decoy(const Node& node, SetsOf& sets) {
  node.expect({"kind", "count", "name", "set", "camera"});
  sets.name = node.at("name", "what it is called in the score").text();
  if (const auto set = node.find("set")) sets.settings = settings_of(*set);
  if (const auto camera = node.find("camera")) sets.camera = config::existing_file(*camera);
  if (sets.settings.empty() && sets.camera.empty())
    node.fail("is like any set without an effect; give another 'camera', or 'set' what the study varies beyond what is believed of it");
}

SetsOf read_sets(const Node& node) {
  if (!node.is_map()) node.fail("is no set; write e.g. {kind: none, count: 5}");
  SetsOf s;
  s.where = node.where();
  s.kind = read_kind(node.at("kind", "none, effect, two, outside or decoy"));
  if (const auto count = node.find("count")) s.count = static_cast<int>(config::read_integer(*count, between(1, kMostSets)));
  switch (s.kind) {
    case Kind::none:
      node.expect({"kind", "count"});
      break;
    case Kind::effect:
      node.expect({"kind", "count", "hypothesis", "strength"});
      s.hypotheses = {node.at("hypothesis", "a hypothesis of the study").text()};
      break;
    case Kind::two:
      node.expect({"kind", "count", "hypotheses", "strength"});
      for (const Node& item : node.at("hypotheses", "two hypotheses of the study").items()) s.hypotheses.push_back(item.text());
      if (s.hypotheses.size() != 2 || s.hypotheses[0] == s.hypotheses[1])
        node.at("hypotheses").fail("is no list of two different hypotheses");
      break;
    case Kind::outside:
      node.expect({"kind", "count", "name", "set"});
      s.name = node.at("name", "what it is called in the score").text();
      s.settings = settings_of(node.at("set", "the physics that the study's list lacks"));
      break;
    case Kind::decoy:
      read_decoy(node, s);
      break;
  }
  if (const auto strength = node.find("strength")) read_strength(*strength, s);
  return s;
}

void check_hypothesis(const SetsOf& sets, const std::string& name, const diagnose::Question& question) {
  std::vector<std::string> names;
  for (const diagnose::Candidate& c : question.candidates) names.push_back(c.name);
  const auto found = std::find_if(question.candidates.begin(), question.candidates.end(), [&](const auto& c) { return c.name == name; });
  if (found == question.candidates.end())
    throw base::UserError(sets.where, fmt::format("'{}' is no hypothesis of the study; {}", name, base::suggestion(name, names)));
  if (!found->on_or_off() && (sets.low < found->range.low || sets.high > found->range.high)) {
    throw base::UserError(sets.where, fmt::format("the strength {:.3g} … {:.3g} of '{}' leaves its range; give {:.3g} … {:.3g}", sets.low,
                                                  sets.high, name, found->range.low, found->range.high));
  }
  for (const std::string& other : sets.hypotheses) {
    if (std::find(found->excludes.begin(), found->excludes.end(), other) != found->excludes.end())
      throw base::UserError(sets.where, fmt::format("'{}' and '{}' cannot hold together; choose another pair", name, other));
  }
}

std::string path_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

bool is_drawn_nuisance(const diagnose::Question& question, const std::string& path) {
  return std::any_of(question.nuisances.begin(), question.nuisances.end(),
                     [&](const diagnose::Nuisance& n) { return !n.usual && n.path == path; });
}

/// Whether it is a parameter of the study, or tied to one, or a nuisance that is drawn.
bool varies(const diagnose::Question& question, const std::string& path) {
  const auto& parameters = question.study.parameters;
  return is_drawn_nuisance(question, path) || std::any_of(parameters.begin(), parameters.end(), [&](const calibrate::Parameter& p) {
           return p.path == path || std::find(p.tied.begin(), p.tied.end(), path) != p.tied.end();
         });
}

/// Whether a setting is what the hypothesis stands for: its value, its switch, or its plugin under another name.
bool stands_for(const diagnose::Candidate& c, const std::string& setting) {
  const std::string path = path_of(setting), kind = setting.substr(path.size());
  if (std::find(c.paths.begin(), c.paths.end(), path) != c.paths.end()) return true;
  return std::any_of(c.set.begin(), c.set.end(), [&](const std::string& on) {
    const std::string other = path_of(on);
    if (c.on_or_off() && other == path) return true;
    return path.ends_with(".kind") && other.ends_with(".kind") && on.substr(other.size()) == kind;
  });
}

/// A decoy sets what the study varies, and nothing else. What is tied goes with its parameter.
void check_decoy(const SetsOf& sets, const diagnose::Question& question) {
  const auto& parameters = question.study.parameters;
  for (const std::string& setting : sets.settings) {
    const std::string path = path_of(setting);
    const auto by_itself = [&](const calibrate::Parameter& p) { return p.path == path && p.tied.empty(); };
    if (is_drawn_nuisance(question, path) || std::any_of(parameters.begin(), parameters.end(), by_itself)) continue;
    throw base::UserError(
        sets.where,
        fmt::format("sets '{}', which is no parameter or drawn nuisance of the study by itself: that is no decoy; its kind is outside",
                    path));
  }
}

/// What is drawn, or what a hypothesis stands for: set beside them it would be scored as what it is not.
void check_settings(const std::vector<std::string>& settings, const base::Location& where, const diagnose::Question& question) {
  for (const std::string& setting : settings) {
    const std::string path = path_of(setting);
    for (const diagnose::Candidate& c : question.candidates) {
      if (stands_for(c, setting))
        throw base::UserError(
            where, fmt::format("sets '{}', which hypothesis '{}' of the study stands for; leave it out, or list the study's 'hypotheses' "
                               "without '{}'",
                               path, c.name, c.name));
    }
    if (varies(question, path))
      throw base::UserError(where, fmt::format("sets '{}', which the study looks for and the challenge draws; leave it out", path));
  }
}

}  // namespace

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::none:
      return "none";
    case Kind::effect:
      return "effect";
    case Kind::two:
      return "two";
    case Kind::outside:
      return "outside";
    case Kind::decoy:
      return "decoy";
  }
  return "";
}

Challenge read_challenge(const fs::path& file, const std::vector<std::string>& overrides) {
  const Node root = config::load_document_with_paths(file.string(), overrides);
  root.expect({"schema_version", "study", "camera", "seed", "truth", "beads", "seconds", "held_out_seconds", "sets"});
  if (const auto version = root.find("schema_version")) {
    if (config::read_integer(*version, between(1, 1e9)) != 1) version->fail("is not 1; this millscope reads version 1");
  }
  Challenge c;
  c.file = file;
  c.study = config::existing_file(root.at("study", "the study that is put to the test, as for 'millscope diagnose'"));
  c.camera = config::existing_file(root.at("camera", "a camera file, e.g. configs/cameras/study.yaml"));
  c.seed =
      static_cast<std::uint64_t>(config::read_integer(root.at("seed", "any number that those who diagnose do not know"), between(0, 9e15)));
  const Node truth = root.at("truth", "how the mill that makes the sets differs from the fitted one, e.g. {set: {stiffness_factor: 0.01}}");
  truth.expect({"set", "engine"});
  c.truth_where = truth.where();
  if (const auto engine = truth.find("engine")) {
    // Another engine is another numerics by itself; settings may come beside it.
    if (const auto set = truth.find("set")) c.truth = settings_of(*set);
    c.truth.push_back("run.engine=" + engine->text());
  } else {
    c.truth = settings_of(truth.at("set", "settings of the case, e.g. {stiffness_factor: 0.01}"));
  }
  if (const auto node = root.find("beads")) c.beads = static_cast<int>(config::read_integer(*node, between(1, kMostBeads)));
  if (const auto node = root.find("seconds")) c.seconds = config::read_number(*node, "s", config::positive());
  const auto held_out = root.find("held_out_seconds");
  c.held_out_seconds = held_out ? config::read_number(*held_out, "s", config::positive()) : c.seconds;
  const Node sets = root.at("sets", "a list of what is made");
  int count = 0;
  for (const Node& item : sets.items()) {
    c.sets.push_back(read_sets(item));
    count += c.sets.back().count;
  }
  if (count < 1 || count > kMostSets) sets.fail(fmt::format("asks for {} sets; give 1 to {}", count, kMostSets));
  return c;
}

diagnose::Question question_of(const Challenge& challenge, const host::Registry& registry) {
  // A study is read only with recordings that exist; its own file stands for those that are still to be made, and nobody opens it.
  std::vector<std::string> overrides;
  const Node conditions = config::load_document_with_paths(challenge.study.string()).at("conditions");
  for (const std::string& name : conditions.keys())
    overrides.push_back(fmt::format("conditions.{}.recording={}", name, nlohmann::json(fs::absolute(challenge.study).string()).dump()));
  diagnose::Question question = diagnose::read_question(challenge.study, overrides, registry);
  if (challenge.held_out_seconds != challenge.seconds && question.study.with_role(calibrate::Role::held_out).empty())
    throw base::UserError(
        fmt::format("{}: held_out_seconds is given, but {} holds no condition out; leave it out, or give one the role held_out",
                    challenge.file.string(), challenge.study.string()));
  for (const diagnose::Nuisance& n : question.nuisances) {
    if (n.of_camera())
      throw base::UserError(
          n.where, fmt::format("nuisance '{}': the recordings of a challenge state no frame that could be doubted; leave it out", n.name));
  }
  check_settings(challenge.truth, challenge.truth_where, question);
  for (const SetsOf& sets : challenge.sets) {
    if (sets.kind == Kind::decoy)
      check_decoy(sets, question);
    else
      check_settings(sets.settings, sets.where, question);
    for (const std::string& name : sets.hypotheses) check_hypothesis(sets, name, question);
  }
  return question;
}

}  // namespace millscope::challenge
