// Diagnoses as `run` left them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

#include "kernel/base/text.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/summary.hpp"
#include "studies/challenge/concealment.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A number that was not finite is null in the file.
double number(const Json& j) { return j.is_number() ? j.get<double>() : std::numeric_limits<double>::quiet_NaN(); }

base::Interval90 interval_from(const Json& j) { return {number(j.at("value")), number(j.at("low90")), number(j.at("high90"))}; }

std::map<std::string, base::Interval90> parameters(const Json& contact, const char* which) {
  std::map<std::string, base::Interval90> out;
  if (!contact.contains(which)) return out;
  for (const auto& [name, value] : contact.at(which).items()) out[name] = interval_from(value);
  return out;
}

std::vector<Gain> gains_from(const Json& held_out) {
  std::vector<Gain> out;
  for (const Json& h : held_out) {
    for (const Json& model : h.at("models")) {
      if (model.contains("improvement_of_corrected"))
        out.push_back({h.at("condition"), model.at("model"), interval_from(model.at("improvement_of_corrected"))});
    }
  }
  return out;
}

std::map<std::string, double> practice_from(const Json& held_out) {
  std::map<std::string, double> out;
  for (const Json& h : held_out) {
    for (const Json& model : h.at("models")) {
      if (model.at("model") != "retuned to power" || !model.contains("parameters")) continue;
      for (const auto& [name, value] : model.at("parameters").items()) out[name] = number(value);
    }
  }
  return out;
}

std::map<std::string, double> power_from(const Json& held_out) {
  std::map<std::string, int> counts;
  std::map<std::string, double> out;
  for (const Json& h : held_out) {
    for (const Json& model : h.at("models")) {
      const double error = model.contains("power_percent") ? number(model.at("power_percent")) : std::nan("");
      if (!std::isfinite(error)) continue;
      const std::string name = model.at("model");
      out[name] += (std::fabs(error) - out[name]) / ++counts[name];
    }
  }
  return out;
}

std::optional<bool> improves_from(const Json& held_out) {
  std::optional<bool> out;
  for (const Json& h : held_out) {
    if (h.value("simulations", 0) > 0) out = out.value_or(true) && h.value("improves_on_every_rival", false);
  }
  return out;
}

Found found_from(const Json& j) {
  Found f;
  f.verdict = j.at("verdict");
  f.named = j.at("named").get<std::vector<std::string>>();
  for (const Json& h : j.at("hypotheses")) {
    Tested t{h.at("name"), h.at("class"), {}, {}};
    for (const Json& point : h.at("lambda_at")) t.lambda_curve.emplace_back(number(point.at("strength")), number(point.at("lambda")));
    const Json& of = h.at("parameters");
    if (!of.empty()) t.strength = interval_from(of.begin().value());
    t.physics = h.value("kind", "physics") == "physics";
    t.tested = h.value("tested", true);
    if (h.contains("p_value")) t.p = number(h.at("p_value"));
    f.hypotheses.push_back(std::move(t));
  }
  f.retuned = parameters(j.at("contact_parameters"), "retuned");
  f.unmasked = parameters(j.at("contact_parameters"), "unmasked");
  f.level = j.value("level", f.level);
  f.together = j.value("named_together", false);
  if (j.contains("base")) {
    const Json& base = j.at("base");
    f.base_p = number(base.at("p_value"));
    if (base.contains("q")) f.base_q = number(base.at("q")) / base.at("observables").get<double>();
  }
  f.power = power_from(j.at("held_out"));
  f.gains = gains_from(j.at("held_out"));
  f.improves = improves_from(j.at("held_out"));
  f.practice = practice_from(j.at("held_out"));
  return f;
}

}  // namespace

std::string Marked::setting(std::string_view key) const {
  std::string value;  // the last one counts
  if (answer.made.empty()) return value;
  for (const auto& setting : answer.made.begin().value().value("settings", nlohmann::ordered_json::array())) {
    const std::string text = setting;
    if (text.starts_with(key) && text.substr(key.size(), 1) == "=") value = text.substr(key.size() + 1);
  }
  return value;
}

std::string Marked::engine() const {
  if (answer.made.empty()) return "";
  const std::string engine = setting("run.engine");
  return engine.empty() ? "millscope" : engine;
}

std::string Marked::peers() const {
  return fmt::format("{}, {}, {}, {}", study, engine(), setting("time.end_s"), setting("output.tracks"));
}

std::string Marked::folder() const {
  const std::size_t slash = answer.set.find('/');
  return slash == std::string::npos ? "" : answer.set.substr(0, slash);
}

std::optional<double> Marked::lambda(const TrueEffect& e) const {
  const Tested* tested = found ? found->find(e.hypothesis) : nullptr;
  const double lambda = tested == nullptr ? std::numeric_limits<double>::quiet_NaN() : tested->lambda(e.strength);
  return std::isfinite(lambda) ? std::optional<double>(lambda) : std::nullopt;
}

double Tested::lambda(double strength) const {
  const auto after = std::find_if(lambda_curve.begin(), lambda_curve.end(), [&](const auto& point) { return point.first >= strength; });
  if (after == lambda_curve.end()) return lambda_curve.empty() ? std::numeric_limits<double>::quiet_NaN() : lambda_curve.back().second;
  if (after == lambda_curve.begin()) return after->second;
  const auto before = std::prev(after);
  const double part = (strength - before->first) / (after->first - before->first);
  const double root = (1 - part) * std::sqrt(before->second) + part * std::sqrt(after->second);
  return root * root;
}

const Tested* Found::find(const std::string& name) const {
  const auto found = std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Tested& t) { return t.name == name; });
  return found == hypotheses.end() ? nullptr : &*found;
}

const Tested* Found::best() const {
  const auto found = std::find_if(hypotheses.begin(), hypotheses.end(), [](const Tested& t) { return t.class_of == "best"; });
  return found == hypotheses.end() ? nullptr : &*found;
}

bool Found::names(const std::string& name) const { return std::find(named.begin(), named.end(), name) != named.end(); }

double Found::smallest_p() const {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const Tested& t : hypotheses) {
    if (t.tested) least = std::fmin(least, t.p);  // of a number and a NaN the number
  }
  return least;
}

double Found::level_of(const Tested& tested) const {
  const auto family = std::count_if(hypotheses.begin(), hypotheses.end(), [](const Tested& t) { return t.tested; });
  return level / static_cast<double>(std::max<std::ptrdiff_t>(family, 1)) / (tested.two_sided() ? 2 : 1);
}

bool Found::is_physics(const std::string& name) const {
  const Tested* tested = find(name);
  return tested == nullptr || tested->physics;
}

bool Found::names_physics() const {
  return std::any_of(named.begin(), named.end(), [&](const std::string& name) { return is_physics(name); });
}

std::optional<Found> read_found(const fs::path& set) {
  const fs::path file = set / "diagnosis" / "diagnosis.json", failed = set / "diagnosis" / "failed.txt";
  if (fs::exists(file)) {
    try {
      const Json diagnosis = Json::parse(base::text_of(file));
      if (diagnosis.at("schema_version") != 2)
        throw base::UserError(
            fmt::format("{}: is of another schema_version than 2, in which 'share' is called 'strength'; remove it and run the challenge "
                        "again",
                        file.string()));
      return found_from(diagnosis);
    } catch (const Json::exception& e) {
      throw base::UserError(
          fmt::format("{}: is no diagnosis that can be scored ({}); remove it and run the challenge again", file.string(), e.what()));
    }
  }
  if (!fs::exists(failed)) return std::nullopt;
  Found f;
  f.failure = base::text_of(failed);
  while (!f.failure.empty() && f.failure.back() == '\n') f.failure.pop_back();
  if (f.failure.empty()) f.failure = "no reason was noted";
  return f;
}

std::map<std::string, Practice> read_concealment(const fs::path& sets) {
  std::map<std::string, Practice> out;
  if (!fs::exists(sets / kConcealmentFile)) return out;
  const auto read = [](const Json& c) -> std::optional<Concealment> {
    if (c.is_null()) return std::nullopt;
    return Concealment{number(c.at("power_percent")), number(c.at("shoulder_deg")), number(c.at("toe_deg")), number(c.at("chagas2015"))};
  };
  const Json j = output::read_json(sets / kConcealmentFile);
  const int version = j.value("schema_version", 0);  // the first has the base that was retuned to power alone
  if (version != 1 && version != 2)
    throw base::UserError(
        fmt::format("{}: schema_version {} is not known here, 1 and 2 are; take the file away, and 'millscope challenge "
                    "conceal' makes it anew",
                    (sets / kConcealmentFile).string(), version));
  const bool both = version == 2;
  for (const auto& [set, c] : j.at("sets").items()) {
    out[set] = both ? Practice{read(c.at("to_power")), read(c.at("to_all"))} : Practice{read(c), {}};
  }
  return out;
}

/// Sentences of whoever looked into sets: lines of "set_001: why".
std::map<std::string, std::string> read_remarks(const fs::path& file) {
  std::map<std::string, std::string> out;
  if (!fs::exists(file)) return out;
  std::istringstream lines(base::text_of(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t colon = line.find(": ");
    if (line.empty()) continue;
    if (colon == std::string::npos)
      throw base::UserError(fmt::format("{}:{}: '{}' is no remark; write set_001: and a sentence", file.string(), number, line));
    if (!out.emplace(line.substr(0, colon), line.substr(colon + 2)).second)
      throw base::UserError(fmt::format("{}:{}: is a second remark on {}; join them", file.string(), number, line.substr(0, colon)));
  }
  return out;
}

/// Of published sets; else empty.
std::string program_of(const fs::path& sets) {
  constexpr std::size_t kDigits = 7;
  if (!fs::exists(sets / kFrozenFile)) return "";
  const Json j = output::read_json(sets / kFrozenFile);
  const auto commit = j.find("commit");
  if (commit == j.end() || !commit->is_string())
    throw base::UserError(
        fmt::format("{}: tells no 'commit'; publish the sets with tools/proof.py, or take the file away", (sets / kFrozenFile).string()));
  return commit->get<std::string>().substr(0, kDigits);
}

std::vector<Marked> read_sets(const fs::path& sets) {
  std::vector<Marked> out;
  std::map<std::string, std::string> remarks = read_remarks(sets / kRemarksFile);
  const std::string study = study_hash(sets), program = program_of(sets);
  const std::map<std::string, Practice> practice = read_concealment(sets);
  for (Answer& a : open_answers(sets)) {
    std::optional<Found> found = read_found(sets / a.set);
    const auto long_runs = practice.find(a.set);
    out.push_back({std::move(a), std::move(found), {}, study, {}, program});
    if (long_runs != practice.end()) out.back().practice = long_runs->second;
    if (auto remark = remarks.extract(out.back().answer.set)) out.back().remark = std::move(remark.mapped());
  }
  if (!remarks.empty())
    throw base::UserError(fmt::format("{}: speaks of '{}', which is no set of this folder; known are set_001 to set_{:03}",
                                      (sets / kRemarksFile).string(), remarks.begin()->first, out.size()));
  return out;
}

std::vector<Marked> read_all_sets(const std::vector<fs::path>& folders) {
  if (folders.size() == 1) return read_sets(folders[0]);
  std::vector<Marked> all;
  std::set<std::string> names, manifests;
  for (const fs::path& folder : folders) {
    const std::string name = output::name_of_folder(folder);
    if (!manifests.insert(manifest_hash(folder)).second)
      throw base::UserError(fmt::format("{}: holds the same sets as a folder before it; leave one out", folder.string()));
    if (!names.insert(name).second)
      throw base::UserError(
          fmt::format("{}: two folders are called '{}', and their sets could not be told apart; rename one", folder.string(), name));
    for (Marked& m : read_sets(folder)) {
      m.answer.set = name + "/" + m.answer.set;
      all.push_back(std::move(m));
    }
  }
  return all;
}

}  // namespace millscope::challenge
