#include "studies/calibrate/study_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"

namespace millscope::calibrate {
namespace {

using config::between;
using config::Node;

constexpr double kMostRuns = 1e6;
constexpr const char* kCameraRemedy = "check the path, or write 'recording' for the camera that the recording shows, or 'exact'";

int whole(const Node& section, const char* key, int standard, double least, double most) {
  const auto node = section.find(key);
  return node ? static_cast<int>(config::read_integer(*node, between(least, most))) : standard;
}

std::vector<std::string> texts(const Node& node) {
  std::vector<std::string> out;
  if (node.is_scalar()) return {node.text()};
  for (const Node& item : node.items()) out.push_back(item.text());
  return out;
}

/// A value as `--set` takes it.
std::string value_text(const Node& node) {
  if (node.is_null()) return "~";
  if (node.is_scalar()) return node.text();
  return fmt::format("[{}]", fmt::join(texts(node), ", "));
}

/// Leaves of a map as "path=value", paths below `root`.
void collect_settings(const Node& node, std::size_t prefix, std::vector<std::string>& settings) {
  if (!node.is_map()) {
    settings.push_back(node.path().substr(prefix) + "=" + value_text(node));
    return;
  }
  for (const std::string& key : node.keys()) collect_settings(node.at(key), prefix, settings);
}

Condition read_condition(const Node& node) {
  node.expect({"set", "recording", "role"});
  Condition condition;
  condition.name = node.name();
  condition.where = node.where();
  if (const auto set = node.find("set")) condition.settings = settings_below(*set);
  const Node recording = node.at("recording", "recording.yaml of this condition");
  condition.recording = config::existing_file(recording, "check the path, or make the recording first");
  condition.role = config::read_choice(node.at("role", "fit or held_out"), "fit|held_out") == "fit" ? Role::fit : Role::held_out;
  return condition;
}

/// A number in SI and the kind of its unit.
config::Quantity quantity(const Node& node) {
  const config::Quantity q = config::read_quantity(node);
  if (q.has_unit && q.unit.dimension == config::parse_unit("%critical").dimension) {
    node.fail("is in %critical, which depends on the case; give rad/s or rpm");
  }
  return q;
}

double value(const Node& node) {
  const config::Quantity q = quantity(node);
  return q.has_unit ? q.unit.to_si(q.number) : q.number;
}

void read_range(const Node& node, Parameter& p) {
  const std::vector<Node> ends = node.items();
  if (ends.size() != 2) node.fail(fmt::format("has {} values; give the lower and the upper end, e.g. [0.1, 0.8]", ends.size()));
  const config::Quantity low = quantity(ends[0]), high = quantity(ends[1]);
  if (low.has_unit && high.has_unit && low.unit.dimension != high.unit.dimension) node.fail("has ends of different kinds; use one unit");
  p.low = value(ends[0]);
  p.high = value(ends[1]);
  if (!(p.low < p.high))
    node.fail(fmt::format("is [{}, {}]: the lower end is not below the upper one; turn them round", ends[0].text(), ends[1].text()));
}

Parameter read_parameter(const Node& node, std::size_t prefix) {
  node.expect({"range", "name", "tied", "centre", "step"});
  Parameter p;
  p.path = node.path().substr(prefix);
  p.where = node.where();
  read_range(node.at("range"), p);
  if (const auto name = node.find("name")) p.name = name->text();
  if (const auto tied = node.find("tied")) p.tied = texts(*tied);
  if (const auto centre = node.find("centre")) {
    p.centre = value(*centre);
    if (!(*p.centre > p.low && *p.centre < p.high))
      centre->fail(fmt::format("is {:.6g}, outside the range {:.6g} … {:.6g}", *p.centre, p.low, p.high));
  }
  if (const auto step = node.find("step")) {
    p.spread = value(*step);
    const double centre = p.centre.value_or(0.5 * (p.low + p.high));
    if (!(*p.spread > 0) || centre - *p.spread < p.low - 1e-12 || centre + *p.spread > p.high + 1e-12) {
      step->fail(fmt::format("is {:.6g}: {:.6g} ± {:.6g} leaves the range {:.6g} … {:.6g}; choose it smaller", *p.spread, centre, *p.spread,
                             p.low, p.high));
    }
  }
  return p;
}

void collect_parameters(const Node& node, std::size_t prefix, std::vector<Parameter>& parameters) {
  if (!node.is_map()) node.fail("is no parameter; write its range, e.g. {range: [0.1, 0.8]}");
  if (node.has("range")) {
    parameters.push_back(read_parameter(node, prefix));
    return;
  }
  const std::vector<std::string> keys = node.keys();
  if (keys.empty()) node.fail("has no range; write e.g. {range: [0.1, 0.8]}");
  for (const std::string& key : keys) collect_parameters(node.at(key), prefix, parameters);
}

std::string last_word(const std::string& path) { return path.substr(path.rfind('.') + 1); }

/// Short names where they are unique.
void name_parameters(std::vector<Parameter>& parameters) {
  std::vector<std::string> words;  // that would be names
  for (const Parameter& p : parameters) words.push_back(p.name.empty() ? last_word(p.path) : p.name);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].name.empty()) continue;
    parameters[i].name = std::count(words.begin(), words.end(), words[i]) == 1 ? words[i] : parameters[i].path;
  }
}

std::string normal_path(const std::string& path) {
  std::string out;
  for (std::size_t begin = 0, dot = 0; dot != std::string::npos; begin = dot + 1) {
    dot = path.find('.', begin);
    out += (out.empty() ? "" : ".") + config::normal_pair(path.substr(begin, dot == std::string::npos ? dot : dot - begin));
  }
  return out;
}

void refuse_twice(const std::vector<Parameter>& parameters) {
  std::vector<std::string> paths, names;
  for (const Parameter& p : parameters) {
    std::vector<std::string> own = p.tied;
    own.push_back(p.path);
    for (const std::string& path : own) {
      if (std::find(paths.begin(), paths.end(), normal_path(path)) != paths.end()) {
        throw base::UserError(p.where, fmt::format("'{}' is given by two parameters; tie it to one of them", path));
      }
      paths.push_back(normal_path(path));
    }
    if (std::find(names.begin(), names.end(), p.name) != names.end())
      throw base::UserError(p.where, fmt::format("two parameters are called '{}'; choose another 'name'", p.name));
    names.push_back(p.name);
  }
}

Term read_term(const Node& node) {
  Term term;
  term.where = node.where();
  const Node name = node.is_map() ? node.at("name", "ANALYZER.RESULT") : node;
  if (node.is_map()) {
    node.expect({"name", "weight"});
    if (const auto weight = node.find("weight")) term.weight = config::read_number(*weight, "1", config::not_negative());
  }
  const std::size_t dot = name.text().find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == name.text().size())
    name.fail(fmt::format("is '{}'; write ANALYZER.RESULT, e.g. slip.mean_slip", name.text()));
  term.analyzer = name.text().substr(0, dot);
  term.result = name.text().substr(dot + 1);
  return term;
}

}  // namespace

std::vector<std::string> settings_below(const Node& map) {
  std::vector<std::string> settings;
  collect_settings(map, map.path().size() + 1, settings);
  return settings;
}

std::vector<Condition> read_conditions(const Node& section) {
  std::vector<Condition> conditions;
  for (const std::string& name : section.keys()) conditions.push_back(read_condition(section.at(name)));
  if (conditions.empty()) section.fail("is empty; give at least one recording");
  return conditions;
}

std::vector<Parameter> read_parameters(const Node& section) {
  std::vector<Parameter> parameters;
  for (const std::string& key : section.keys()) collect_parameters(section.at(key), section.path().size() + 1, parameters);
  if (parameters.empty()) section.fail("is empty; give at least one parameter with its range");
  name_parameters(parameters);
  refuse_twice(parameters);
  return parameters;
}

ObjectiveChoice read_objective(const Node& node) {
  ObjectiveChoice choice;
  const Node kind = node.is_map() ? node.at("kind", "likelihood or chagas2015") : node;
  choice.kind = config::read_choice(kind, "likelihood|chagas2015") == "likelihood" ? ObjectiveKind::likelihood : ObjectiveKind::chagas2015;
  if (!node.is_map()) return choice;
  node.expect({"kind", "terms", "without"});
  if (const auto terms = node.find("terms")) {
    for (const Node& item : terms->items()) choice.terms.push_back(read_term(item));
  }
  if (const auto without = node.find("without")) {
    for (const Node& item : without->items())
      choice.without.push_back(kind_named(config::read_choice(item, "power|centre|x|y|speed|occupancy|region_speed")));
  }
  return choice;
}

DesignChoice read_design(const Node& section) {
  section.expect({"generators", "screening_centre_points", "descent_steps", "kept_factors", "composite_step", "axial",
                  "composite_centre_points", "start", "start_runs", "batch", "seed"});
  DesignChoice d;
  if (const auto node = section.find("generators")) d.generators = texts(*node);
  d.screening_centre_points = whole(section, "screening_centre_points", d.screening_centre_points, 0, 100);
  d.descent_steps = whole(section, "descent_steps", d.descent_steps, 0, 100);
  d.kept_factors = whole(section, "kept_factors", d.kept_factors, 2, 8);
  if (const auto node = section.find("composite_step"))
    d.composite_step = config::read_number(*node, "1", between(0.01, 2, "of the screening's step"));
  if (const auto node = section.find("axial")) d.axial = config::read_choice(*node, "rotatable|face_centred");
  d.composite_centre_points = whole(section, "composite_centre_points", d.composite_centre_points, 1, 100);
  if (const auto node = section.find("start")) d.start = config::read_choice(*node, "latin_hypercube|sobol");
  d.start_runs = whole(section, "start_runs", d.start_runs, 4, kMostRuns);
  d.batch = whole(section, "batch", d.batch, 1, 1000);
  d.seed = static_cast<std::uint64_t>(whole(section, "seed", 1, 0, 2e9));
  return d;
}

Budget read_budget(const Node& section) {
  section.expect({"simulations", "wall"});
  Budget budget;
  budget.simulations = whole(section, "simulations", budget.simulations, 1, kMostRuns);
  if (const auto node = section.find("wall")) budget.wall = config::read_number(*node, "s", config::positive());
  return budget;
}

Observing read_observing(const Node& section) {
  section.expect({"camera", "beads", "z_low", "z_high", "draws"});
  Observing o;
  if (const auto node = section.find("camera"))
    o.camera = node->text() == "recording" || node->text() == "exact" ? node->text() : config::existing_file(*node, kCameraRemedy);
  o.beads = whole(section, "beads", o.beads, 20, kMostRuns);
  o.draws = whole(section, "draws", o.draws, 100, 10000);
  const auto low = section.find("z_low"), high = section.find("z_high");
  if (low.has_value() != high.has_value()) (low ? *low : *high).fail("stands alone; give both 'z_low' and 'z_high'");
  if (low) {
    o.z_low = config::read_number(*low, "m");
    o.z_high = config::read_number(*high, "m");
    if (!(*o.z_high > *o.z_low)) high->fail("is not above 'z_low'");
  }
  return o;
}

std::optional<Eigen::Index> find_parameter(const std::vector<Parameter>& parameters, const std::string& name) {
  const std::string path = normal_path(name);
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name || normal_path(p.path) == path; });
  return found == parameters.end() ? std::nullopt : std::optional<Eigen::Index>(found - parameters.begin());
}

}  // namespace millscope::calibrate
