#include "studies/calibrate/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernel/base/statistics.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/calibrate/outputs.hpp"
#include "studies/emulate/statements.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using Json = nlohmann::ordered_json;

using base::kNormal90;

Judged judge(const Observable& what, double recorded, double simulated, double error) {
  Judged j{what, recorded, simulated, simulated - recorded, error, 0, 0, 1, false};
  j.low = j.difference - kNormal90 * error;
  j.high = j.difference + kNormal90 * error;
  j.p = std::erfc(std::fabs(j.difference) / (error * std::sqrt(2.0)));
  return j;
}

ValidatedCondition judge_condition(const Evaluator& evaluator, const Trial& trial, std::size_t condition) {
  ValidatedCondition v;
  v.condition = condition;
  v.failed = trial.failed;
  v.message = trial.message;
  if (!trial.folders.empty()) v.folder = trial.folders.front();
  if (trial.failed) return v;
  const Observation &recorded = evaluator.recorded(condition), &simulated = trial.observed.front();
  for (Eigen::Index i = 0; i < recorded.value.size(); ++i) {
    v.observables.push_back(judge(recorded.observables[i], recorded.value[i], simulated.value[i],
                                  std::sqrt(recorded.covariance(i, i) + simulated.covariance(i, i))));
  }
  v.power = judge({"power", "W", ObservableKind::power}, recorded.power.value, simulated.power.value,
                  std::hypot(recorded.power.sem, simulated.power.sem));
  v.chagas = trial.chagas;
  v.misfit = trial.misfit;
  if (!v.observables.empty()) v.p = emulate::misfit_probability(v.misfit, static_cast<double>(v.observables.size()));
  v.simulated = simulated;
  return v;
}

/// Half of the family's level is for observables one by one, half for those of a condition at once: χ² is about right there, but not far
/// out where errors come from few blocks (tests/calibrate/objective_test.cpp). Each half is shared out by Šidák.
double level_of_each(std::size_t tests) {
  return 1 - std::pow(1 - kFamilyLevel / 2, 1.0 / static_cast<double>(std::max<std::size_t>(1, tests)));
}

void pass_or_fail(Validation& validation) {
  std::size_t conditions = 0;
  for (const ValidatedCondition& c : validation.conditions) {
    validation.judged += c.observables.size();
    conditions += c.observables.empty() ? 0 : 1;
  }
  const double one = level_of_each(validation.judged), all = level_of_each(conditions);
  for (ValidatedCondition& c : validation.conditions) {
    c.power.pass = c.power.p >= one;
    c.pass = c.p >= all;
    validation.at_once = validation.at_once && c.pass;
    for (Judged& j : c.observables) {
      j.pass = j.p >= one;
      validation.passed += j.pass ? 1 : 0;
    }
  }
}

/// "The simulation and the recordings differ. One by one …"
std::string verdict(const Validation& v, const Evaluator& evaluator) {
  std::vector<std::string> fail;
  for (const ValidatedCondition& c : v.conditions) {
    if (!c.pass) fail.push_back(evaluator.study().conditions[c.condition].name);
  }
  return fmt::format("{}{}. One by one, {} of {} observables pass. All of a condition at once: {}. Level: {:.0f} % for all of this.",
                     v.failed() > 0 ? fmt::format("{} of {} simulations failed. ", v.failed(), v.conditions.size()) : "",
                     v.agrees() ? "The simulation agrees with the recordings" : "The simulation and the recordings differ", v.passed,
                     v.judged, v.at_once ? "pass" : fmt::format("fail at {}", fmt::join(fail, ", ")), 100 * kFamilyLevel);
}

Json judged_json(const Judged& j) {
  return {{"name", j.observable.name},
          {"unit", j.observable.unit},
          {"recorded", j.recorded},
          {"simulated", j.simulated},
          {"difference", j.difference},
          {"error", j.error},
          {"low90", j.low},
          {"high90", j.high},
          {"p", j.p},
          {"pass", j.pass}};
}

void add_row(std::string& out, const Judged& j) {
  fmt::format_to(std::back_inserter(out), "| {} | {} | {:.4g} | {:.4g} | {:+.3g} | {:+.3g} … {:+.3g} | {} |\n", j.observable.name,
                 j.observable.unit, j.recorded, j.simulated, j.difference, j.low, j.high, j.pass ? "pass" : "**fail**");
}

}  // namespace

std::ptrdiff_t Validation::failed() const {
  return std::count_if(conditions.begin(), conditions.end(), [](const ValidatedCondition& c) { return c.failed; });
}

Eigen::VectorXd calibrated_set(const fs::path& file, const Study& study) {
  const std::optional<std::string> text = base::text_if_readable(file);
  if (!text) throw UserError(fmt::format("{}: cannot be read; give the calibration.json that 'millscope calibrate' wrote", file.string()));
  const Json j = Json::parse(*text, nullptr, false);
  if (!j.is_object() || !j.contains("parameters") || !j["parameters"].is_array())
    throw UserError(fmt::format("{}: is no calibration.json; give the one that 'millscope calibrate' wrote", file.string()));
  Eigen::VectorXd point(static_cast<Eigen::Index>(study.parameters.size()));
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    bool found = false;
    for (const Json& parameter : j["parameters"]) {
      if (parameter.value("path", "") != study.parameters[p].path || !parameter.contains("value") || !parameter["value"].is_number())
        continue;
      point[static_cast<Eigen::Index>(p)] = parameter["value"];
      found = true;
    }
    if (!found)
      throw UserError(study.parameters[p].where, fmt::format("parameter '{}' has no value in {}; calibrate this study again",
                                                             study.parameters[p].path, file.string()));
  }
  return point;
}

Validation validate(Evaluator& evaluator, const Eigen::VectorXd& point, const std::vector<std::size_t>& conditions) {
  Validation validation;
  validation.point = point;
  for (const auto& [condition, trial] : evaluator.each_in(point, conditions))
    validation.conditions.push_back(judge_condition(evaluator, trial, condition));
  pass_or_fail(validation);
  if (validation.judged == 0)
    throw UserError(
        fmt::format("no simulation of the validation came to its end, the first so: {}", validation.conditions.front().message));
  return validation;
}

Json validation_json(const Validation& v, const Evaluator& evaluator) {
  Json j{{"schema_version", 2},  {"study", evaluator.study().file.string()}, {"pass", v.pass()}, {"judged", v.judged}, {"passed", v.passed},
         {"at_once", v.at_once}, {"family_wise_level", kFamilyLevel}};
  for (std::size_t p = 0; p < evaluator.study().parameters.size(); ++p)
    j["parameters"][evaluator.study().parameters[p].name] = v.point[static_cast<Eigen::Index>(p)];
  for (const ValidatedCondition& c : v.conditions) {
    const Condition& of = evaluator.study().conditions[c.condition];
    Json one{{"role", of.role == Role::fit ? "fit" : "held_out"}, {"folder", c.folder.string()}};
    if (c.failed) {
      one["failed"] = c.message;
    } else {
      if (std::isfinite(c.power.recorded)) {
        one["power"] = judged_json(c.power);
        one["power"]["percent"] = 100 * c.power.difference / c.power.recorded;
        one["chagas2015"] = {
            {"value", c.chagas.value()}, {"power_W", c.chagas.power}, {"x_percent", c.chagas.x}, {"speed_percent", c.chagas.speed}};
      }
      one["misfit"] = c.misfit;
      one["p"] = c.p;
      one["pass"] = c.pass;
      for (const Judged& o : c.observables) one["observables"].push_back(judged_json(o));
    }
    j["conditions"][of.name] = one;
  }
  return j;
}

std::string validation_text(const Validation& v, const Evaluator& evaluator) {
  std::string out = "# Validation\n\n" + verdict(v, evaluator) + "\n\n";
  for (const ValidatedCondition& c : v.conditions) {
    const Condition& of = evaluator.study().conditions[c.condition];
    fmt::format_to(std::back_inserter(out), "## {} ({})\n\n", of.name, of.role == Role::fit ? "was fitted" : "held out");
    if (c.failed) {
      out += "The simulation failed: " + c.message + "\n\n";
      continue;
    }
    if (std::isfinite(c.power.recorded))
      fmt::format_to(std::back_inserter(out),
                     "Power {:.4g} W recorded, {:.4g} W simulated: {:+.2f} % ({:+.2f} … {:+.2f} %), {}. Eq. 4.3: {:.3g}. ",
                     c.power.recorded, c.power.simulated, 100 * c.power.difference / c.power.recorded, 100 * c.power.low / c.power.recorded,
                     100 * c.power.high / c.power.recorded, c.power.pass ? "pass" : "fail", c.chagas.value());
    fmt::format_to(std::back_inserter(out), "All {} observables at once: misfit {:.4g} where about {} is usual (p = {:.2g}), {}.\n\n",
                   c.observables.size(), c.misfit, c.observables.size(), c.p, c.pass ? "pass" : "**fail**");
    out += "| observable | unit | recorded | simulated | difference | 90 % interval | |\n|---|---|---|---|---|---|---|\n";
    for (const Judged& j : c.observables) add_row(out, j);
    out += "\n";
  }
  return out;
}

void write_validation(const Validation& v, const Evaluator& evaluator, const fs::path& folder) {
  fs::create_directories(folder / "pictures");
  std::string text = validation_text(v, evaluator);
  for (const ValidatedCondition& c : v.conditions) {
    if (c.failed) continue;
    const std::string& name = evaluator.study().conditions[c.condition].name;
    for (const fs::path& file : draw_distributions(name, evaluator.recorded(c.condition), c.simulated, folder / "pictures"))
      text += fmt::format("![{}](pictures/{})\n\n", file.stem().string(), file.filename().string());
  }
  output::write_file(folder / "validation.md", text);
  output::write_json(folder / "validation.json", validation_json(v, evaluator));
}

}  // namespace millscope::calibrate
