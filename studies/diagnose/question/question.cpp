#include "studies/diagnose/question/question.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/config/units.hpp"
#include "kernel/config/writer.hpp"
#include "studies/diagnose/question/camera_frame.hpp"
#include "studies/diagnose/question/feasible.hpp"

namespace millscope::diagnose {
namespace {

using config::Node;

constexpr double kLeastLevel = 0.01, kMostLevel = 0.2;

double number(const Node& node) {
  const config::Quantity quantity = config::read_quantity(node);
  if (quantity.has_unit && quantity.unit.dimension == config::parse_unit("%critical").dimension)
    node.fail("is in %critical, which depends on the case; give rad/s or rpm");
  return quantity.has_unit ? quantity.unit.to_si(quantity.number) : quantity.number;
}

template <class Read>
std::pair<double, double> range(const Node& node, Read&& read) {
  const std::vector<Node> ends = node.items();
  if (ends.size() != 2) node.fail(fmt::format("has {} values; give the lower and the upper end, e.g. [0, 0.2]", ends.size()));
  const double low = read(ends[0]), high = read(ends[1]);
  if (!(low < high)) node.fail("has its lower end not below the upper one; turn them round");
  return {low, high};
}

void collect_nuisances(const Node& node, std::size_t prefix, const host::Registry& registry, std::vector<Nuisance>& out) {
  if (!node.is_map()) node.fail("is no nuisance; write e.g. {range: [30 %, 32 %], sigma: 0.3 %}");
  if (!node.has("range")) {
    for (const std::string& key : node.keys()) collect_nuisances(node.at(key), prefix, registry, out);
    return;
  }
  Nuisance n;
  n.path = node.path().substr(prefix);
  node.expect({"range", "sigma", "mean", "name", "apart"});
  n.where = node.where();
  const std::string unit = n.of_camera() ? camera_frame_unit(node, n.path, registry) : "";
  const auto read = [&](const Node& value) { return n.of_camera() ? config::read_number(value, unit) : number(value); };
  std::tie(n.low, n.high) = range(node.at("range"), read);
  n.asked = {n.low, n.high};
  n.mean = node.has("mean") ? read(node.at("mean")) : 0.5 * (n.low + n.high);
  n.sigma = read(node.at("sigma", "standard deviation of what is known of it"));
  n.name = node.has("name") ? node.at("name").text() : n.path.substr(n.path.rfind('.') + 1);
  if (!(n.mean > n.low && n.mean < n.high))
    node.fail(fmt::format("has its mean {:.6g} outside the range {:.6g} … {:.6g}", n.mean, n.low, n.high));
  if (!(n.sigma > 0)) node.at("sigma").fail("is not above 0; leave out what is known exactly");
  if (const auto apart = node.find("apart"); apart && config::read_flag(*apart)) {
    if (n.of_camera()) apart->fail("is true for the camera, which costs no simulation; leave it out");
    n.usual = std::numeric_limits<double>::quiet_NaN();  // until the case is read
  }
  out.push_back(std::move(n));
}

/// A hypothesis of a plugin that needs values besides, which 'set' may give; else an empty one.
Candidate incomplete(const Library& library, const std::string& name) {
  for (const Candidate& c : library.incomplete) {
    if (c.name == name) return c;
  }
  return {};
}

/// A hypothesis of the study: one of the library with changes, or one of its own.
Candidate read_candidate(const Node& node, const Library& library) {
  node.expect({"sentence", "equation", "citation", "path", "paths", "without", "range", "set", "excludes"});
  const auto known =
      std::find_if(library.candidates.begin(), library.candidates.end(), [&](const Candidate& c) { return c.name == node.name(); });
  const bool own = node.has("path") || node.has("set");
  if (known == library.candidates.end() && !own) {
    for (const std::string& line : library.left_out) {
      if (line.starts_with(node.name() + ":")) node.fail("does not apply: " + line.substr(node.name().size() + 2));
    }
    std::vector<std::string> names;
    for (const Candidate& c : library.candidates) names.push_back(c.name);
    node.fail(fmt::format("is no hypothesis of a loaded plugin; known: {}; or give it a 'path' with 'without' and 'range', or a 'set'",
                          fmt::join(names, ", ")));
  }
  Candidate c = known == library.candidates.end() ? incomplete(library, node.name()) : *known;
  c.name = node.name();
  if (node.has("sentence")) c.sentence = node.at("sentence").text();
  if (c.sentence.empty()) node.fail("has no 'sentence' that says what it means, e.g. The lifters are worn.");
  if (node.has("equation")) c.equation = node.at("equation").text();
  if (node.has("citation")) c.citation = node.at("citation").text();
  if (node.has("set")) {
    for (std::string& setting : calibrate::settings_below(node.at("set"))) c.set.push_back(std::move(setting));
  }
  if (node.has("path")) {
    c.paths = {node.at("path").text()};
    c.parameter = c.paths[0].substr(c.paths[0].rfind('.') + 1);
    c.null_value = number(node.at("without", "the value at which it vanishes"));
  }
  if (node.has("range")) {
    if (c.on_or_off()) node.at("range").fail("has no 'path' that takes its values; give one, or leave the range out: it is on or off");
    const auto [low, high] = range(node.at("range"), number);
    const bool downwards = std::fabs(low - c.null_value) > std::fabs(high - c.null_value);
    c.far = downwards ? low : high;
    const double near = ((downwards ? high : low) - c.null_value) / (c.far - c.null_value);
    if (near > 0) node.at("range").fail(fmt::format("does not hold {:.6g}, where it vanishes", c.null_value));
    c.range = {near, 1};
  } else if (node.has("path")) {
    node.fail("has a 'path' but no 'range'; give both ends, e.g. [3 mm, 5 mm]");
  }
  return c;
}

/// The parameters in the middle of their ranges must give a case that can be run.
void check_parameters(const Question& question, const host::Registry& registry) {
  try {
    std::vector<std::string> settings;
    for (const calibrate::Parameter& p : question.study.parameters)
      settings.push_back(fmt::format("{}={:.6g}", p.path, 0.5 * (p.low + p.high)));
    resolved(question.study, settings, registry);
  } catch (const base::UserError& e) {
    throw base::UserError(question.study.parameters.front().where, fmt::format("parameters in the middle of their ranges: {}", e.what()));
  }
}

/// Simulations without a candidate are called so.
bool bank_group(const std::string& name) { return name == "base" || name == "again"; }

void check_nuisance(const Question& question, const Nuisance& n, const host::Registry& registry) {
  if (bank_group(n.name))
    throw base::UserError(n.where, fmt::format("nuisance '{}' has the name of a group of the bank; give it another 'name'", n.name));
  for (const Nuisance& other : question.nuisances) {
    if (&other != &n && other.name == n.name)
      throw base::UserError(n.where, fmt::format("there are two nuisances '{}'; give one of them another 'name'", n.name));
  }
  for (const calibrate::Parameter& p : question.study.parameters) {
    if (p.path == n.path || p.name == n.name)
      throw base::UserError(n.where, fmt::format("nuisance '{}' is a parameter, too; keep one of them, or give it another 'name'", n.name));
  }
  if (n.of_camera()) return check_camera_frame(n, registry);
  if (n.usual && !(rounded(*n.usual) >= rounded(n.low) && rounded(*n.usual) <= rounded(n.high)))
    throw base::UserError(n.where, fmt::format("nuisance '{}' is apart, and its range {:.6g} … {:.6g} does not hold {:.6g}, which it is "
                                               "in {}; widen the range",
                                               n.name, n.low, n.high, *n.usual, question.study.base.string()));
  try {
    const std::string low = resolved(question.study, {fmt::format("{}={:.17g}", n.path, n.low)}, registry);
    if (low != resolved(question.study, {fmt::format("{}={:.17g}", n.path, n.high)}, registry)) return;
  } catch (const base::UserError& e) {
    throw base::UserError(n.where, fmt::format("nuisance '{}': {}", n.name, e.what()));
  }
  throw base::UserError(n.where, fmt::format("nuisance '{}' changes nothing in {}: the case overrides it; leave it out", n.path,
                                             question.study.base.string()));
}

/// Why the candidate gives no case that can be run; "" when it does.
std::string refused(const Question& question, const Candidate& c, const host::Registry& registry) {
  if (bank_group(c.name)) return "has the name of a group of the bank; give it another";
  for (const Nuisance& n : question.nuisances) {
    if (n.name == c.name) return "is the name of a nuisance, too; give that another 'name'";
    const bool sets = std::any_of(c.set.begin(), c.set.end(), [&](const std::string& s) { return s.starts_with(n.path + "="); });
    if (sets || std::find(c.paths.begin(), c.paths.end(), n.path) != c.paths.end())
      return fmt::format("changes {}, which is the nuisance '{}' already; keep one of them", n.path, n.name);
  }
  try {
    const std::string without = resolved(question.study, {}, registry);
    if (c.range.low < 0) resolved(question.study, settings_of(c, c.range.low), registry);
    if (resolved(question.study, settings_of(c, 1), registry) == without) return "changes nothing in the base case; leave it out";
  } catch (const base::UserError& e) {
    return e.what();
  }
  return "";
}

void read_candidates(const Node& node, const Library& library, const host::Registry& registry, Question& question) {
  for (const std::string& key : node.keys()) {
    const Node one = node.at(key);
    question.candidates.push_back(read_candidate(one, library));
    if (const std::string why = refused(question, question.candidates.back(), registry); !why.empty())
      throw base::UserError(one.where(), fmt::format("hypothesis '{}': {}", key, why));
  }
}

/// What nuisances that are varied apart are in the case: the same in all conditions.
void read_usual(Question& question) {
  for (Nuisance& n : question.nuisances) {
    if (!n.usual) continue;
    for (const calibrate::Condition& c : question.study.conditions) {
      const double value = value_in(config::read_case(question.study.base.string(), c.settings), n.path, n.where);
      if (&c != &question.study.conditions.front() && value != *n.usual)
        throw base::UserError(n.where, fmt::format("nuisance '{}' is apart, and is {:.6g} in condition '{}', {:.6g} in '{}'; give it one "
                                                   "value in all",
                                                   n.name, *n.usual, question.study.conditions.front().name, value, c.name));
      n.usual = value;
    }
  }
}

void settle_speeds(Question& question) {
  for (calibrate::Condition& c : question.study.conditions) {
    const config::Case at = config::read_case(question.study.base.string(), c.settings);
    question.speed.push_back(at.mill ? std::fabs(at.mill->speed) : 0.0);
    for (const std::string& settled : speeds_settled(at)) {
      std::erase_if(c.settings, [&](const std::string& setting) { return setting.starts_with(settled.substr(0, settled.find('=') + 1)); });
      c.settings.push_back(settled);
    }
  }
}

double read_develop_turns(const Node& bank, const Question& question) {
  const auto node = bank.find("develop_turns");
  if (!node) return 0;
  const double turns = config::read_number(*node, "1", config::not_negative());
  for (std::size_t c = 0; turns > 0 && c < question.study.conditions.size(); ++c) {
    const calibrate::Condition& condition = question.study.conditions[c];
    if (question.speed[c] == 0)
      node->fail(fmt::format("counts turns, and the mill of condition '{}' does not turn; leave it out", condition.name));
    const double from = config::read_case(question.study.base.string(), condition.settings).time.analyze_from;
    const double most = from * question.speed[c] / (2 * std::numbers::pi);
    if (turns > most)
      node->fail(
          fmt::format("is {}, and the analysis of condition '{}' begins after {:.4f} turns (time.analyze_from_s = {:.6g} s); give "
                      "no more than that",
                      turns, condition.name, std::floor(1e4 * most) / 1e4, from));
  }
  return turns;
}

/// Every candidate of the library that gives a case which can be run.
void take_all(const Library& library, const host::Registry& registry, Question& question) {
  for (const Candidate& c : library.candidates) {
    if (const std::string why = refused(question, c, registry); why.empty())
      question.candidates.push_back(c);
    else
      question.left_out.push_back(c.name + ": " + why);
  }
}

}  // namespace

double value_in(const config::Case& c, const std::string& path, const base::Location& where) {
  Node node = c.root;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const auto found = node.is_map() ? node.find(path.substr(begin, end - begin)) : std::nullopt;
    if (!found) throw base::UserError(where, fmt::format("'{}' is not in {}; write there what it is", path, c.root.where().file));
    node = *found;
    begin = end + 1;
  }
  const config::Quantity quantity = config::read_quantity(node);
  return quantity.has_unit ? quantity.unit.to_si(quantity.number) : quantity.number;
}

std::vector<naming::Coordinate> Question::coordinates() const {
  std::vector<naming::Coordinate> out;
  for (const calibrate::Parameter& p : study.parameters) out.push_back({p.name, p.low, p.high, 0, 0, false, naming::Products::all, {}});
  for (const Nuisance& n : nuisances) {
    const bool wide = n.usual && n.low > 0 && n.high >= naming::kWideRange * n.low;
    out.push_back({n.name, n.low, n.high, n.mean, n.sigma, wide,
                   n.of_camera() ? naming::Products::none
                   : n.usual     ? naming::Products::parameters
                                 : naming::Products::all,
                   n.usual});
  }
  return out;
}

std::size_t Question::case_dimensions() const {
  const auto of_case = std::count_if(nuisances.begin(), nuisances.end(), [](const Nuisance& n) { return !n.of_camera() && !n.usual; });
  return study.parameters.size() + of_case;
}

std::string Question::camera(const VectorXd& theta) const {
  std::vector<std::pair<const Nuisance*, double>> of;
  for (std::size_t i = 0; i < nuisances.size(); ++i) {
    if (nuisances[i].of_camera()) of.emplace_back(&nuisances[i], theta[study.parameters.size() + i]);
  }
  return of.empty() ? "" : camera_frame_text(of);
}

std::vector<std::string> Question::settings(const VectorXd& theta, const std::vector<naming::ActiveCandidate>& active) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    const std::string value = fmt::format("{:.4g}", theta[i]);
    out.push_back(study.parameters[i].path + "=" + value);
    for (const std::string& path : study.parameters[i].tied) out.push_back(fmt::format("{}={}", path, value));
  }
  for (std::size_t i = 0; i < nuisances.size(); ++i) {
    const Nuisance& n = nuisances[i];
    const std::string value = fmt::format("{:.4g}", theta[study.parameters.size() + i]);
    if (!n.of_camera() && !(n.usual && value == fmt::format("{:.4g}", *n.usual))) out.push_back(fmt::format("{}={}", n.path, value));
  }
  for (const naming::ActiveCandidate& e : active) {
    for (std::string& s : settings_of(candidates[e.candidate], e.strength)) out.push_back(std::move(s));
  }
  return out;
}

Question read_question(const std::filesystem::path& file, const std::vector<std::string>& overrides, const host::Registry& registry) {
  Question question;
  question.study = calibrate::read_study(file, overrides, calibrate::kDiagnoseSections);
  const Node& root = question.study.root;
  if (const auto node = root.find("nuisances")) collect_nuisances(*node, node->path().size() + 1, registry, question.nuisances);
  const auto rank = [](const Nuisance& n) { return n.of_camera() ? 2 : n.usual ? 1 : 0; };
  std::stable_sort(question.nuisances.begin(), question.nuisances.end(),
                   [&](const Nuisance& a, const Nuisance& b) { return rank(a) < rank(b); });
  read_usual(question);
  const config::Case base = config::read_case(question.study.base.string(), question.study.conditions.front().settings);
  settle_speeds(question);
  check_parameters(question, registry);
  for (const Nuisance& n : question.nuisances) check_nuisance(question, n, registry);
  const Library library = library_of(base, registry);
  question.left_out = library.left_out;
  if (const auto node = root.find("hypotheses"))
    read_candidates(*node, library, registry, question);
  else
    take_all(library, registry, question);
  std::erase_if(question.left_out, [&question](const std::string& line) {  // what a 'set' has completed is tested
    return std::any_of(question.candidates.begin(), question.candidates.end(),
                       [&](const Candidate& c) { return line.starts_with(c.name + ":"); });
  });
  exclude_impossible(registry, question);
  if (const auto node = root.find("bank")) {
    node->expect({"base", "each", "apart", "first", "develop_turns"});
    const auto whole = [&](const char* key, int standard, double least) {
      const auto value = node->find(key);
      return value ? static_cast<int>(config::read_integer(*value, config::between(least, 1e5))) : standard;
    };
    const int base = whole("base", 24, 8);
    question.bank = {base, whole("each", 10, 1), whole("apart", base, 8), whole("first", 4, 1), read_develop_turns(*node, question)};
  }
  if (const auto node = root.find("level"))
    question.level = config::read_number(*node, "1", config::between(kLeastLevel, kMostLevel, "it is how often a false alarm is allowed"));
  find_farthest(registry, question);
  return question;
}

}  // namespace millscope::diagnose
