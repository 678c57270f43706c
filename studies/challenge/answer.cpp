#include "studies/challenge/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "kernel/base/text.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/campaign/identity.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using Json = nlohmann::ordered_json;

fs::path answer_file(const fs::path& sets, const std::string& set) { return sets / "answers" / (set + ".json"); }

Json read_manifest(const fs::path& sets) {
  const fs::path file = sets / "manifest.json";
  if (!fs::is_regular_file(file))
    throw UserError(
        fmt::format("{}: is no folder of sets (it has no manifest.json); make one: millscope challenge make CHALLENGE.yaml -o {}",
                    sets.string(), sets.string()));
  const Json j = output::read_json(file);
  if (!j.is_object() || !j.contains("sets")) throw UserError(fmt::format("{}: is damaged; make the sets again", file.string()));
  return j;
}

Kind kind_from(const std::string& text) {
  for (const Kind kind : kKinds) {
    if (text == name_of(kind)) return kind;
  }
  return Kind::outside;
}

}  // namespace

Json to_json(const Answer& a, const std::string& salt) {
  Json effects = Json::array(), theta = Json::object();
  for (const TrueEffect& e : a.effects) {
    effects.push_back({{"hypothesis", e.hypothesis},
                       {"strength", e.strength},
                       {"parameter", e.parameter},
                       {"value", e.value},
                       {"vanishes_at", e.vanishes_at},
                       {"far", e.far}});
  }
  for (const auto& [name, value] : a.theta) theta[name] = value;
  return {{"schema_version", 2}, {"set", a.set},       {"salt", salt},   {"kind", name_of(a.kind)},
          {"name", a.name},      {"effects", effects}, {"theta", theta}, {"made", a.made}};
}

Answer answer_from(const Json& j) {
  Answer a;
  a.set = j.at("set");
  a.kind = kind_from(j.at("kind"));
  a.name = j.at("name");
  // A sealed answer stays as its hash was published: those of version 1 call a strength a share.
  const char* strength = j.at("schema_version") == 1 ? "share" : "strength";
  for (const Json& e : j.at("effects"))
    a.effects.push_back({e.at("hypothesis"), e.at(strength), e.at("parameter"), e.at("value"), e.at("vanishes_at"), e.at("far")});
  for (const auto& [name, value] : j.at("theta").items()) a.theta.emplace_back(name, value.get<double>());
  a.made = j.value("made", Json::object());
  return a;
}

std::string fresh_salt() {
  std::random_device device;
  std::string salt;
  for (int i = 0; i < 4; ++i) salt += fmt::format("{:08x}", device());
  return salt;
}

void seal(const fs::path& sets, const std::vector<Answer>& answers, const fs::path& study) {
  fs::create_directories(sets / "answers");
  Json list = Json::array();
  for (const Answer& a : answers) {
    output::write_json(answer_file(sets, a.set), to_json(a, fresh_salt()));
    list.push_back({{"set", a.set}, {"answer_hash", campaign::content_hash(base::text_of(answer_file(sets, a.set)))}});
  }
  output::write_json(sets / "manifest.json",
                     {{"schema_version", 1},
                      {"hash", "SHA-1 of the bytes of answers/SET.json, its first 32 hexadecimal digits as a version 5 UUID"},
                      {"study_hash", campaign::content_hash(base::text_of(study))},
                      {"sets", list}});
}

std::vector<std::string> set_names(const fs::path& sets) {
  std::vector<std::string> names;
  const Json manifest = read_manifest(sets);
  for (const Json& s : manifest.at("sets")) names.push_back(s.at("set"));
  return names;
}

std::vector<Answer> open_answers(const fs::path& sets) {
  std::vector<Answer> answers;
  const Json manifest = read_manifest(sets);
  for (const Json& s : manifest.at("sets")) {
    const std::string name = s.at("set");
    const fs::path file = answer_file(sets, name);
    if (!fs::is_regular_file(file)) throw UserError(fmt::format("{}: is missing; without every answer nothing is scored", file.string()));
    const std::string bytes = base::text_of(file);
    if (campaign::content_hash(bytes) != s.at("answer_hash").get<std::string>())
      throw UserError(
          fmt::format("{}: is not the answer that manifest.json has the hash of; it was changed after the sets were made, so nothing is "
                      "scored: put the sealed answer back",
                      file.string()));
    answers.push_back(answer_from(Json::parse(bytes)));
  }
  return answers;
}

std::string study_hash(const fs::path& sets) { return read_manifest(sets).at("study_hash"); }

std::string manifest_hash(const fs::path& sets) {
  read_manifest(sets);
  return campaign::content_hash(base::text_of(sets / "manifest.json"));
}

}  // namespace millscope::challenge
