#include "studies/calibrate/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"
#include "studies/calibrate/study_sections.hpp"

namespace millscope::calibrate {
namespace {

using config::Node;

constexpr int kConstraintTrials = 20000;

/// Radical inverse: evenly spread numbers in 0 … 1.
double halton(int index, int base) {
  double value = 0, weight = 1;
  for (int i = index; i > 0; i /= base) value += (weight /= base) * (i % base);
  return value;
}

/// Constraints that leave nothing of the ranges contradict them.
void require_room(const Study& study, const Node& constraints) {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  const Eigen::VectorXd low = study.low(), span = study.high() - low;
  for (int trial = 1; trial <= kConstraintTrials; ++trial) {
    Eigen::VectorXd point = low;
    for (Eigen::Index p = 0; p < point.size(); ++p) point[p] += span[p] * halton(trial, kPrimes[p % 16]);
    if (study.allowed(point)) return;
  }
  constraints.fail(
      fmt::format("leave nothing of the ranges ({} points were tried): they contradict each other; loosen one", kConstraintTrials));
}

constexpr double kMostPowerError = 0.5;

void read_method(const Node& root, Study& study) {
  if (const auto node = root.find("method")) {
    const std::string method = config::read_choice(*node, "response_surface|emulator|cma_es");
    study.method = method == "emulator" ? Method::emulator : method == "cma_es" ? Method::cma_es : Method::response_surface;
  }
  if (const auto node = root.find("objective")) study.objective = read_objective(*node);
  if (const auto node = root.find("design")) study.design = read_design(*node);
  if (const auto node = root.find("budget")) study.budget = read_budget(*node);
  if (const auto node = root.find("observe")) study.observing = read_observing(*node);
  if (const auto node = root.find("power_error")) {
    study.power_error = config::read_number(*node, "1", config::between(0, kMostPowerError, "it is a share of the power"));
  }
  if (const auto node = root.find("runner")) study.runner = config::read_choice(*node, "local|slurm");
}

void require_fit(const Study& study, const Node& conditions) {
  if (study.with_role(Role::fit).empty()) {
    conditions.fail("has no condition with 'role: fit': there is nothing to calibrate on; give one of them that role");
  }
}

}  // namespace

Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides, std::span<const std::string_view> also) {
  const Node root = config::load_document_with_paths(file.string(), overrides);
  for (const std::string_view section : also) root.has(section);  // known from now on
  root.expect({"schema_version", "base", "conditions", "parameters", "constraints", "objective", "method", "design", "budget", "runner",
               "observe", "analyzers", "power_error"});
  if (const auto version = root.find("schema_version")) {
    if (config::read_integer(*version, config::between(1, 1e9)) != 1) version->fail("is not 1; this millscope reads version 1");
  }
  Study study;
  study.file = file;
  study.root = root;
  const Node base = root.at("base", "the case that is calibrated, e.g. slice_75.yaml");
  study.base = config::existing_file(base);
  study.base_place = base.where();
  const Node conditions = root.at("conditions", "recordings with their settings");
  study.conditions = read_conditions(conditions);
  require_fit(study, conditions);
  study.parameters = read_parameters(root.at("parameters", "paths of the case with their ranges"));
  read_method(root, study);
  if (const auto node = root.find("constraints")) {
    for (const Node& item : node->items()) study.constraints.push_back(read_constraint(item, study.parameters));
    require_room(study, *node);
  }
  return study;
}

Eigen::VectorXd Study::low() const {
  Eigen::VectorXd v(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) v[static_cast<Eigen::Index>(i)] = parameters[i].low;
  return v;
}

Eigen::VectorXd Study::high() const {
  Eigen::VectorXd v(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) v[static_cast<Eigen::Index>(i)] = parameters[i].high;
  return v;
}

bool Study::allowed(const Eigen::VectorXd& point) const {
  return std::all_of(constraints.begin(), constraints.end(), [&](const Constraint& c) { return c.holds(point); });
}

std::vector<std::size_t> Study::with_role(Role role) const {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    if (conditions[i].role == role) chosen.push_back(i);
  }
  return chosen;
}

std::vector<std::string> settings_of(const Study& study, const Eigen::VectorXd& point) {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    const std::string value = config::number_text(point[static_cast<Eigen::Index>(i)]);
    settings.push_back(study.parameters[i].path + "=" + value);
    for (const std::string& path : study.parameters[i].tied) settings.push_back(path + "=" + value);
  }
  return settings;
}

const char* name_of(Method method) {
  return method == Method::emulator ? "emulator" : method == Method::cma_es ? "cma_es" : "response_surface";
}

const char* name_of(ObjectiveKind kind) { return kind == ObjectiveKind::likelihood ? "likelihood" : "chagas2015"; }

}  // namespace millscope::calibrate
