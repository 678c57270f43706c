#include "studies/calibrate/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/config/document.hpp"
#include "kernel/config/units.hpp"
#include "kernel/output/csv.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<double> list(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

const char* name_of(emulate::Determined d) {
  return d == emulate::Determined::well ? "well" : d == emulate::Determined::weakly ? "weakly" : "hardly";
}

Json trial_json(const Evaluator& evaluator, const Trial& t) {
  if (t.failed) return {{"point", list(t.point)}, {"stage", t.stage}, {"state", "failed"}, {"message", t.message}};
  return {{"point", list(t.point)},
          {"stage", t.stage},
          {"state", "done"},
          {"objective", evaluator.objective(t)},
          {"chagas2015",
           {{"value", t.chagas.value()},
            {"power_W", t.chagas.power},
            {"x_percent", t.chagas.x},
            {"speed_percent", t.chagas.speed},
            {"terms", t.chagas.terms}}},
          {"misfit", t.misfit}};
}

Json sum_json(const doe::SumOfSquares& s) { return {{"sum", s.value}, {"df", s.df}, {"F", s.F}, {"p", s.p}}; }

Json screening_json(const Screening& s) {
  Json effects = Json::array();
  for (const doe::Effect& e : s.anova.effects)
    effects.push_back({{"name", e.name}, {"alias", e.alias}, {"effect", e.value}, {"sum", sum_json(e.sum)}, {"pooled", e.pooled}});
  Json kept = Json::array();
  for (const std::size_t f : s.kept) kept.push_back(s.anova.factors[f].name);
  Json j{{"resolution", s.run.design.resolution},
         {"aliases", s.run.design.aliases},
         {"effects", effects},
         {"residual", sum_json(s.anova.residual)},
         {"kept", kept},
         {"notes", s.anova.notes}};
  if (s.anova.curvature) j["curvature"] = sum_json(*s.anova.curvature);
  return j;
}

Json composite_json(const Composite& c) {
  Json coefficients = Json::array();
  for (const doe::Coefficient& k : c.surface.coefficients)
    coefficients.push_back({{"name", k.name}, {"value", k.value}, {"standard_error", k.standard_error}, {"F", k.F}, {"p", k.p}});
  Json factors = Json::array();
  for (const doe::Factor& f : c.surface.factors) factors.push_back({{"name", f.name}, {"centre", f.centre}, {"step", f.step}});
  Json j{{"factors", factors},
         {"coefficients", coefficients},
         {"lack_of_fit", sum_json(c.surface.lack_of_fit)},
         {"pure_error", sum_json(c.surface.pure_error)},
         {"lack_of_fit_means", c.surface.lack_of_fit_sentence},
         {"r_squared", c.surface.r_squared},
         {"notes", c.surface.notes}};
  if (!c.surface.stationary) return j;
  const doe::StationaryPoint& s = *c.surface.stationary;
  j["stationary"] = {
      {"natural", list(s.natural)}, {"kind", doe::name_of(s.kind)}, {"inside", s.inside}, {"value", s.value}, {"sentence", s.sentence}};
  if (s.region)
    j["stationary"]["region"] = {{"confidence", s.region->confidence},
                                 {"low", list(doe::natural(c.surface.factors, s.region->low))},
                                 {"high", list(doe::natural(c.surface.factors, s.region->high))}};
  return j;
}

Json parameters_json(const Study& study, const Calibration& c) {
  Json all = Json::array();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const Parameter& of = study.parameters[p];
    const auto i = static_cast<Eigen::Index>(p);
    Json j{{"name", of.name}, {"path", of.path}, {"tied", of.tied}, {"range", {of.low, of.high}}, {"value", c.best[i]}};
    if (c.inference) {
      const emulate::Marginal& m = c.inference->posterior.marginal[p];
      const emulate::Profile& profile = c.inference->profiles[p];
      j["posterior"] = {{"mean", m.mean},
                        {"median", m.median},
                        {"mode", m.mode},
                        {"low90", m.low90},
                        {"high90", m.high90},
                        {"low50", m.low50},
                        {"high50", m.high50},
                        {"r_hat", m.r_hat},
                        {"width_ratio", m.width_ratio},
                        {"determined", name_of(m.determined)},
                        {"statement", m.statement}};
      j["profile"] = {{"low_alone", profile.low_alone},
                      {"high_alone", profile.high_alone},
                      {"low_readjusted", profile.low_readjusted},
                      {"high_readjusted", profile.high_readjusted},
                      {"concealed", profile.concealed}};
    }
    all.push_back(std::move(j));
  }
  return all;
}

}  // namespace

Json calibration_json(const Evaluator& evaluator, const Calibration& c) {
  const Study& study = evaluator.study();
  Json j{{"schema_version", 1},
         {"study", study.file.string()},
         {"base", study.base.string()},
         {"method", name_of(study.method)},
         {"objective", name_of(study.objective.kind)},
         {"best", list(c.best)},
         {"how", c.how},
         {"predicted_objective", c.predicted},
         {"simulations", evaluator.simulations()}};
  j["parameters"] = parameters_json(study, c);
  if (c.at_best) j["at_best"] = trial_json(evaluator, *c.at_best);
  if (c.screening) j["screening"] = screening_json(*c.screening);
  if (!c.descent.empty()) {
    for (const Trial& t : c.descent) j["descent"].push_back(trial_json(evaluator, t));
  }
  if (c.composite) j["surface"] = composite_json(*c.composite);
  if (c.inference) {
    const emulate::Posterior& p = c.inference->posterior;
    Json rows = Json::array();
    for (Eigen::Index r = 0; r < p.correlation.rows(); ++r) rows.push_back(list(p.correlation.row(r).transpose()));
    j["posterior"] = {{"mode", list(p.mode)},
                      {"correlation", rows},
                      {"misfit", p.misfit},
                      {"misfit_probability", p.misfit_probability},
                      {"converged", p.converged},
                      {"statements", p.statements},
                      {"observables", c.inference->observables},
                      {"emulator_coverage90", c.inference->diagnostics.coverage90_all}};
  }
  Json failed = Json::array();
  for (const Trial& t : evaluator.trials()) {
    if (t.failed) failed.push_back(trial_json(evaluator, t));
  }
  j["failed"] = failed;
  j["doubts"] = campaign::doubts_json(c.doubts);
  j["notes"] = c.notes;
  Json recordings = Json::object();
  for (std::size_t k = 0; k < study.conditions.size(); ++k) {
    const Observation& o = evaluator.recorded(k);
    recordings[study.conditions[k].name] = {{"recording", study.conditions[k].recording.string()},
                                            {"role", study.conditions[k].role == Role::fit ? "fit" : "held_out"},
                                            {"power_W", o.power.value},
                                            {"power_sem_W", o.power.sem},
                                            {"power_is", o.power.how},
                                            {"bead_seconds", o.bead_seconds},
                                            {"observables", o.value.size()},
                                            {"notes", o.notes}};
  }
  j["conditions"] = recordings;
  return j;
}

std::string case_with(const std::string& comment, const fs::path& base, const std::vector<std::string>& settings, const fs::path& folder) {
  std::vector<std::string> named;
  for (const std::string& setting : settings) named.push_back(setting.substr(0, setting.find('=')));
  const std::string included = fs::absolute(base).lexically_proximate(fs::absolute(folder)).string();
  std::string out = fmt::format("# {}\nschema_version: 1\ninclude: [{}]\n", comment, Json(included).dump());
  const std::string file = base.string();
  out += config::difference(config::load_document(file), config::load_document(file, settings), named);
  return out;
}

std::string calibrated_yaml(const Study& study, const Eigen::VectorXd& best, const fs::path& folder) {
  return case_with(fmt::format("Found by 'millscope calibrate {}'. Run it, or include it after the case of another condition.",
                               study.file.filename().string()),
                   study.base, settings_of(study, best), folder);
}

/// The power where it is not among the numbers that are compared: a column of its own.
bool power_apart(const Observation& o) { return !o.find(ObservableKind::power); }

std::string runs_csv(const Evaluator& evaluator) {
  const Study& study = evaluator.study();
  std::string out = "number,stage,replicate,state";
  for (const Parameter& p : study.parameters) out += "," + output::csv_cell(p.name);
  out += ",objective,chagas2015,chagas_power_W,chagas_x_percent,chagas_speed_percent,misfit,wall_s";
  const std::vector<std::size_t> conditions = study.with_role(Role::fit);
  for (const std::size_t c : conditions) {
    if (power_apart(evaluator.recorded(c))) out += "," + output::csv_cell(study.conditions[c].name + " power (W)");
    for (const Observable& o : evaluator.recorded(c).observables)
      out += "," + output::csv_cell(study.conditions[c].name + " " + o.name + " (" + o.unit + ")");
  }
  out += ",folders,message\n";
  std::size_t number = 0;
  for (const Trial& t : evaluator.trials()) {
    out += fmt::format("{},{},{},{}", ++number, t.stage, t.replicate, t.failed ? "failed" : "done");
    for (const double v : t.point) out += "," + config::number_text(v);
    const auto cell = [&](double v) { return t.failed ? std::string(",") : "," + config::number_text(v); };
    out += cell(evaluator.objective(t)) + cell(t.chagas.value()) + cell(t.chagas.power) + cell(t.chagas.x) + cell(t.chagas.speed) +
           cell(t.misfit) + "," + config::number_text(t.wall_s);
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      if (power_apart(evaluator.recorded(conditions[k]))) out += cell(t.failed ? 0 : t.observed[k].power.value);
      for (Eigen::Index i = 0; i < evaluator.recorded(conditions[k]).value.size(); ++i) out += cell(t.failed ? 0 : t.observed[k].value[i]);
    }
    std::string folders;
    for (const fs::path& folder : t.folders) folders += (folders.empty() ? "" : " ") + folder.string();
    out += "," + output::csv_cell(folders) + "," + output::csv_cell(t.message) + "\n";
  }
  return out;
}

void write_outputs(const Evaluator& evaluator, const Calibration& calibration, const fs::path& folder) {
  fs::create_directories(folder / "pictures");
  const std::vector<fs::path> pictures = draw(evaluator, calibration, folder / "pictures");
  output::write_file(folder / "runs.csv", runs_csv(evaluator));
  output::write_file(folder / "calibrated.yaml", calibrated_yaml(evaluator.study(), calibration.best, folder));
  output::write_file(folder / "report.md", report_text(evaluator, calibration, pictures));
  output::write_json(folder / "calibration.json", calibration_json(evaluator, calibration));
}

}  // namespace millscope::calibrate
