// corrected/: the case with the physics that was found, and a study to go on with.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/calibrate/outputs.hpp"
#include "studies/diagnose/pages/outputs.hpp"

namespace millscope::diagnose {
namespace {

namespace fs = std::filesystem;

/// What the study chose besides.
std::string choices_text(const Question& q) {
  const calibrate::Observing& o = q.study.observing;
  std::string out = fmt::format("\nobserve: {{camera: {}, beads: {}, draws: {}", nlohmann::json(o.camera).dump(), o.beads, o.draws);
  if (o.z_low && o.z_high) fmt::format_to(std::back_inserter(out), ", z: [{:.6g}, {:.6g}]", *o.z_low, *o.z_high);
  fmt::format_to(std::back_inserter(out), "}}\nbank: {{base: {}, each: {}, apart: {}, first: {}{}}}\npower_error: {:.6g}\nlevel: {:.6g}\n",
                 q.bank.base, q.bank.each, q.bank.apart, q.bank.first,
                 q.bank.develop_turns > 0 ? fmt::format(", develop_turns: {}", q.bank.develop_turns) : "", q.study.power_error, q.level);
  std::vector<std::string> without;
  for (const calibrate::ObservableKind kind : q.study.objective.without) without.emplace_back(calibrate::name_of(kind));
  if (!without.empty()) fmt::format_to(std::back_inserter(out), "objective: {{without: [{}]}}\n", fmt::join(without, ", "));
  if (!q.study.constraints.empty()) out += "constraints:\n";
  for (const calibrate::Constraint& c : q.study.constraints)
    fmt::format_to(std::back_inserter(out), "  - {}\n", nlohmann::json(c.text).dump());
  return out;
}

/// A base that is no case without a condition's settings has none to settle.
std::vector<std::string> base_speeds(const fs::path& base) {
  try {
    return speeds_settled(config::read_case(base.string()));
  } catch (const base::UserError&) {
    return {};
  }
}

/// The alternative by which the fit that is told leaves the prior of a coordinate; null: it does not.
const naming::Judged* freed_by(const Told& t, std::size_t coordinate) {
  const naming::Result& naming = t.diagnosis.naming;
  std::vector<Index> told{*naming.best};
  if (t.diagnosis.two_effects) told.push_back(naming.pairs.front().second);
  for (const Index k : told) {
    if (t.diagnosis.problem.alternatives[k].freed == static_cast<Index>(coordinate)) return &naming.judged[k];
  }
  return nullptr;
}

/// Of a class the best alone.
std::string what_is_on(const Told& t) {
  const std::vector<std::string>& named = t.diagnosis.named;
  const std::string all = fmt::format("{}", fmt::join(named, t.diagnosis.two_effects ? " and " : ", "));
  return t.diagnosis.two_effects || named.size() == 1 ? all : fmt::format("{}, the best of {}", named.front(), all);
}

/// A nuisance of the study. Where the fit that is told stands by leaving its prior, that is believed from here on, no more surely than it
/// was found; not at an end of what was simulated, where nobody knows.
std::string nuisance_text(const Told& t, std::size_t i, double value) {
  const Nuisance& n = t.question.nuisances[i];
  const std::size_t coordinate = t.question.study.parameters.size() + i;
  const bool fixed = n.of_camera() || n.usual;
  const Farthest farthest = fixed ? Farthest{n.low, n.high} : t.question.farthest[coordinate];
  double low = n.low, high = n.high, mean = n.mean, sigma = n.sigma;
  const naming::Judged* by = freed_by(t, coordinate);
  const bool at_end = naming::at_limit(t.diagnosis.problem.data.theta[coordinate].coded(value), {-1, 1});
  if (!n.usual && by != nullptr && !at_end) {
    mean = rounded(value);
    if (by->theta[coordinate].known()) sigma = std::max(sigma, rounded(by->theta[coordinate].standard_error()));
    if (value <= low) low = farthest.low;
    if (value >= high) high = farthest.high;
  }
  return fmt::format("{}: {{name: {}, range: [{:.6g}, {:.6g}], mean: {:.6g}, sigma: {:.6g}{}}}{}", n.path, n.name, low, high, mean, sigma,
                     n.usual ? ", apart: true" : "", mean == n.mean ? "" : "  # as these recordings have it");
}

/// `theta`: as fitted.
std::string study_text(const Told& t, const VectorXd& theta, const fs::path& folder) {
  std::string out = fmt::format("# The study {} on the corrected case.\nschema_version: 1\nbase: case.yaml\n\nconditions:\n",
                                t.question.study.file.filename().string());
  for (const calibrate::Condition& c : t.question.study.conditions) {
    fmt::format_to(std::back_inserter(out), "  {}:\n    recording: {}\n    role: {}\n{}", c.name,
                   nlohmann::json(fs::absolute(c.recording).lexically_proximate(fs::absolute(folder)).string()).dump(),
                   c.role == calibrate::Role::fit ? "fit" : "held_out", c.settings.empty() ? "" : "    set:\n");
    for (const std::string& s : c.settings)
      fmt::format_to(std::back_inserter(out), "      {}: {}\n", s.substr(0, s.find('=')), s.substr(s.find('=') + 1));
  }
  out += "\nparameters:\n";
  for (std::size_t i = 0; i < t.question.study.parameters.size(); ++i) {
    const calibrate::Parameter& p = t.question.study.parameters[i];
    const double value = rounded(theta[static_cast<Index>(i)]);
    const bool outside = value < p.low || value > p.high;
    fmt::format_to(std::back_inserter(out), "  {}: {{name: {}, range: [{:.6g}, {:.6g}], tied: [{}]}}{}\n", p.path, p.name,
                   std::min(p.low, value), std::max(p.high, value), fmt::join(p.tied, ", "),
                   outside ? "  # wider than asked: the fit lies outside" : "");
  }
  if (!t.question.nuisances.empty()) out += "\nnuisances:\n";
  for (std::size_t i = 0; i < t.question.nuisances.size(); ++i)
    fmt::format_to(std::back_inserter(out), "  {}\n",
                   nuisance_text(t, i, theta[static_cast<Index>(t.question.study.parameters.size() + i)]));
  return out + choices_text(t.question);
}

}  // namespace

void write_corrected(const Told& t, const fs::path& folder) {
  if (!t.diagnosis.naming.best || t.diagnosis.verdict == Verdict::outside_library) return;
  const auto [fit, active] = fit_of(t.diagnosis);
  const VectorXd theta = t.diagnosis.problem.data.natural(fit.coded);
  std::vector<std::string> settings = base_speeds(t.question.study.base);
  for (const std::string& s : t.question.settings(theta, active)) settings.push_back(s);
  const std::size_t parameters = t.question.study.parameters.size();
  bool of_camera = false;
  for (std::size_t i = 0; i < t.question.nuisances.size(); ++i)
    of_camera = of_camera || (t.question.nuisances[i].of_camera() && freed_by(t, parameters + i) != nullptr);
  fs::create_directories(folder);
  output::write_file(folder / "case.yaml",
                     calibrate::case_with(fmt::format("{} {}, as 'millscope diagnose' found it: {}.",
                                                      of_camera ? "The mill behind" : "With", what_is_on(t), name_of(t.diagnosis.verdict)),
                                          t.question.study.base, settings, folder));
  output::write_file(folder / "study.yaml", study_text(t, theta, folder));
}

void write_outputs(const Told& told, const fs::path& folder) {
  fs::create_directories(folder);
  fs::remove_all(folder / "corrected");
  const std::vector<fs::path> pictures = draw(told, folder / "pictures");
  write_corrected(told, folder / "corrected");
  output::write_file(folder / "diagnosis.md", diagnosis_text(told, pictures));
  output::write_json(folder / "diagnosis.json", diagnosis_json(told));
}

}  // namespace millscope::diagnose
